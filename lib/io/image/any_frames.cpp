// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/any_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/image/capture_folder.hpp"
#include "io/image/frame_sink.hpp"
#include "io/image/image_file.hpp"
#include "io/image/video.hpp"
#include "io/stream/stream.hpp"
#include "model/metadata.hpp"

namespace vam::io {

namespace {

model::StackInfo frames_of(int width, int height, int count) {
  model::StackInfo info;
  info.kind = model::Kind::frames;
  info.space = model::Space::projector;
  info.width = width;
  info.height = height;
  info.count = count;
  info.units = "fraction of full grey";
  return info;
}

class StackSource : public ImageSource {
 public:
  explicit StackSource(const std::string& path) : reader_(path) {}
  [[nodiscard]] const model::StackInfo& info() const override { return reader_.info(); }
  [[nodiscard]] std::vector<model::ImageInfo> about() const override { return reader_.about(); }
  bool next(Image& image, model::ImageInfo& about) override { return reader_.next(image, about); }
  [[nodiscard]] bool is_sealed() const override { return reader_.is_sealed(); }

 private:
  StackReader reader_;
};

class VideoSource : public ImageSource {
 public:
  explicit VideoSource(const std::string& path) : reader_(path) {
    times_s_ = video_frame_times(path);
    info_ = frames_of(reader_.format().width, reader_.format().height, count_of(times_s_) - 1);
    if (!reader_.format().facts.empty()) take_frame_facts(reader_.format().facts, info_, path);
    const double fps = reader_.format().fps, made_for = model::stated_number(info_.extra, "vam:fps").value_or(fps);
    constexpr double same = 1e-3;
    if (std::abs(fps - made_for) <= same * made_for) return;
    throw Error{Fault::data, path + ": plays " + format_number(fps) + " frames per second, but was made for " +
                                 format_number(made_for) + " (vam:fps); give it this rate, or write it again"};
  }
  [[nodiscard]] const model::StackInfo& info() const override { return info_; }
  bool next(Image& image, model::ImageInfo& about) override {
    GreyImage grey;
    if (!reader_.next(grey)) return false;
    image = fractions(grey);
    about = {.time_s = times_s_[std::min(taken_++, times_s_.size() - 1)], .has_time = true};
    return true;
  }
  [[nodiscard]] std::vector<double> times_s() const override { return times_s_; }
  [[nodiscard]] bool is_grey() const override { return true; }
  [[nodiscard]] bool is_sealed() const override { return reader_.format().seal.has_value(); }
  [[nodiscard]] std::string seal() const override {
    constexpr std::size_t head = 5, digits = 16;
    return is_sealed() ? seal_text(*reader_.format().seal).substr(head, digits) : "";
  }
  [[nodiscard]] bool has_checksums() const override { return reader_.format().checksums; }

 private:
  VideoReader reader_;
  model::StackInfo info_;
  std::vector<double> times_s_;
  std::size_t taken_ = 0;
};

// frames.csv of vam-project beside the images: file,time_s,angle_deg, a line an image. Empty when there is none.
std::vector<model::ImageInfo> read_frame_index(const std::string& path, const ImageFolder& images) {
  if (!has_regular_file(path)) return {};
  std::vector<std::string> lines = split(read_all(path, Content::text, std::uint64_t{64} << 20), '\n');
  if (!lines.empty() && lines.back().empty()) lines.pop_back();
  for (std::string& line : lines) {
    if (line.ends_with('\r')) line.pop_back();
  }
  std::size_t number = 1;
  const auto damaged = [&](const std::string& what) {
    return Error{Fault::data, path + ":" + std::to_string(number) + ": " + what +
                                  "; restore it, or remove it where the images are evenly spaced"};
  };
  if (lines.empty() || lines.front() != "file,time_s,angle_deg")
    throw damaged("does not begin with file,time_s,angle_deg");
  std::vector<model::ImageInfo> index;
  while (number < lines.size()) {
    const auto cells = split(lines[number++], ',');
    const auto time_s = cells.size() == 3 ? parse_number(cells[1]) : std::nullopt;
    const auto angle_deg = cells.size() == 3 ? parse_number(cells[2]) : std::nullopt;
    if (!time_s || !angle_deg || !std::isfinite(*time_s) || !std::isfinite(*angle_deg)) {
      throw damaged("not a file name, a time and an angle");
    }
    const int at = count_of(index);
    if (at == images.count() || cells[0] != std::filesystem::path(images.path(at)).filename()) {
      throw damaged(excerpt(cells[0]) + " is not image " + std::to_string(at) + " of the folder");
    }
    index.push_back({.angle_deg = *angle_deg, .time_s = *time_s, .has_angle = true, .has_time = true});
  }
  if (count_of(index) < images.count()) {
    throw damaged("the last line, of " + std::to_string(index.size()) + " for " + std::to_string(images.count()) +
                  " images");
  }
  return index;
}

// Lines of the manifest, by their images; none where the folder is not one of vam-capture.
std::map<std::string, CaptureRecord> captured_images(const std::string& folder) {
  std::map<std::string, CaptureRecord> records;
  if (!is_capture_folder(folder)) return records;
  for (const auto& [place, record] : open_capture(folder).frames) records[capture_file_name(place)] = record;
  return records;
}

/// Images of a folder, grey or one a file as Dr.TVAM writes its patterns (0000.exr, 0001.exr, ...), with the angles of
/// its index and its facts.
class FolderSource : public ImageSource {
 public:
  FolderSource(const std::string& path, FolderOf of)
      : grey_(of == FolderOf::grey),
        folder_(path, false, of),
        facts_(path + "/facts.txt"),
        index_path_(path + "/frames.csv"),
        index_(read_frame_index(index_path_, folder_)) {
    if (grey_) captured_ = captured_images(path);
    first_ = read(0);
    info_ = frames_of(first_.width, first_.height, folder_.count());
    if (!grey_) info_.units = "relative";
    if (has_regular_file(facts_)) take_facts(read_all(facts_, Content::text, std::uint64_t{1} << 20));
    if (index_.size() > 1) info_.angle_step_deg = index_[1].angle_deg - index_[0].angle_deg;
  }
  [[nodiscard]] const model::StackInfo& info() const override { return info_; }
  [[nodiscard]] std::vector<model::ImageInfo> about() const override { return index_; }
  [[nodiscard]] bool is_grey() const override { return grey_; }
  [[nodiscard]] bool is_sealed() const override { return sealed_; }
  bool next(Image& image, model::ImageInfo& about) override {
    if (taken_ == folder_.count()) return false;
    about = index_.empty() ? model::ImageInfo{} : index_[taken_];
    image = taken_ == 0 ? std::move(first_) : read(taken_);
    ++taken_;
    return true;
  }

 private:
  /// Where they end in a seal, the frames and their index are held to it, too.
  void take_facts(const std::string& text) {
    const std::size_t end = std::min(text.rfind(std::string(values_seal_key) + " "), text.size());
    const std::string facts = text.substr(0, end);
    take_frame_facts(facts, info_, facts_);
    sealed_ = end < text.size();
    if (!sealed_) return;
    std::vector<std::string> paths;
    for (int i = 0; i < folder_.count(); ++i) paths.push_back(folder_.path(i));
    if (!index_.empty()) paths.push_back(index_path_);
    std::vector<Digest> files(paths.size());
    parallel_for(count_of(paths), [&](int i) {
      const std::string bytes = read_all(paths[i], Content::binary);
      files[i] = digest_of(bytes.data(), bytes.size());
    });
    if (text.substr(end) == frame_seal(facts, files)) return;
    throw Error{Fault::data, facts_ + ": the facts or the " + std::to_string(folder_.count()) +
                                 " frames beside it are not those that were written; write them again, or remove its "
                                 "last line if the change was intentional"};
  }

  Image read(int i) {
    const std::string& path = folder_.path(i);
    if (grey_) {
      const GreyImage levels = folder_.read(i);
      const auto record = captured_.find(std::filesystem::path(path).filename());
      if (record != captured_.end()) require_captured(path, record->second, levels);
      return fractions(levels);
    }
    Image image = read_exr_image(path);
    if (i == 0 || (image.width == info_.width && image.height == info_.height)) return image;
    throw Error{Fault::data, path + ": has " + size_text(image.width, image.height) +
                                 " pixels, but those before have " + size_text(info_.width, info_.height)};
  }

  bool grey_;
  ImageFolder folder_;
  std::string facts_, index_path_;
  std::vector<model::ImageInfo> index_;
  std::map<std::string, CaptureRecord> captured_;
  model::StackInfo info_;
  Image first_;
  bool sealed_ = false;
  int taken_ = 0;
};

}  // namespace

std::unique_ptr<ImageSource> open_images(const std::string& path, FileType type) {
  if (type == FileType::video && path == "-")
    throw Error{Fault::usage, "stdin: a video is read from a file only; name it"};
  if (type == FileType::video) return std::make_unique<VideoSource>(path);
  if (type == FileType::images)
    return std::make_unique<FolderSource>(path, is_exr_folder(path) ? FolderOf::exr : FolderOf::grey);
  return std::make_unique<StackSource>(path);
}

}  // namespace vam::io
