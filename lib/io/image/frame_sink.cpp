// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/frame_sink.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/image/video.hpp"

namespace vam::io {

namespace {

constexpr const char* index_name = "frames.csv";
constexpr const char* facts_name = "facts.txt";
constexpr const char* step_name = "vam:angle_step_deg";

bool is_frame(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const bool digits = !stem.empty() && stem.find_first_not_of("0123456789") == std::string::npos;
  return file.filename() == index_name || file.filename() == facts_name || (digits && file.extension() == ".png");
}

std::string number_name(int number) {
  char name[32];
  std::snprintf(name, sizeof name, "%05d.png", number);
  return name;
}

}  // namespace

std::string frame_facts(const model::StackInfo& info) {
  std::string text;
  for (const auto& [name, value] : info.extra) {
    if (name.starts_with("vam:") && value.find('\n') == std::string::npos) text += name + " " + trimmed(value) + "\n";
  }
  return text + step_name + " " + format_number(info.angle_step_deg, 12) + "\n";
}

void take_frame_facts(const std::string& text, model::StackInfo& info, const std::string& name) {
  std::optional<double> step;
  for (const std::string& line : split(trimmed(text), '\n')) {
    const std::size_t blank = line.find(' ');
    const std::string fact = line.substr(0, blank);
    if (!line.starts_with("vam:") || blank == std::string::npos || step || (is_own_fact(fact) && fact != step_name))
      throw Error{Fault::data, name + ": states '" + excerpt(line) + "', which is no fact of frames; write them again"};
    const std::string value = trimmed(line.substr(blank));
    if (fact == step_name)
      step = parse_number(value);
    else
      info.extra[fact] = value;
  }
  if (!step || !(std::abs(*step) <= 360))
    throw Error{Fault::data, name + ": the facts of its frames do not end with an angle as " + step_name +
                                 "; they are damaged or cut off; write them again"};
  info.angle_step_deg = *step;
}

std::string frame_seal(const std::string& facts, std::span<const Digest> files) {
  Sealer sealer;
  sealer.add(facts);
  for (const Digest& file : files) sealer.add(file);
  return std::string(values_seal_key) + " " + seal_text(sealer.digest()) + "\n";
}

FrameFolder::FrameFolder(const std::string& path) : folder_(path, is_frame) {}

Digest FrameFolder::write(int number, const GreyImage& frame, const ImageText& text) const {
  const auto png = encode_png(frame, text);
  folder_.write(number_name(number), png);
  return digest_of(png.data(), png.size());
}

void FrameFolder::commit(std::span<const model::ImageInfo> frames, const std::string& facts,
                         std::vector<Digest> digests) {
  std::string index = "file,time_s,angle_deg\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    index += number_name(static_cast<int>(i)) + "," + format_number(frames[i].time_s, 9) + "," +
             format_number(frames[i].angle_deg, 9) + "\n";
  }
  folder_.write(index_name, index);
  digests.push_back(digest_of(index.data(), index.size()));
  if (!facts.empty()) folder_.write(facts_name, facts + frame_seal(facts, digests));
  folder_.commit();
}

namespace {

model::ImageInfo about(const ProjectorFrame& frame) {
  return {.angle_deg = frame.angle_deg, .time_s = frame.time_s, .has_angle = true, .has_time = true};
}

class FolderSink : public FrameSink {
 public:
  FolderSink(const std::string& path, const FrameSinkOptions& options)
      : folder_(path),
        fps_(format_number(options.fps, 9)),
        history_(join(options.info.history, "\n")),
        facts_(frame_facts(options.info)) {}

  void write(std::span<const ProjectorFrame> frames) override {
    const int first = count_of(shown_);
    digests_.resize(shown_.size() + frames.size());
    parallel_for(count_of(frames),
                 [&](int i) { digests_[first + i] = folder_.write(first + i, frames[i].levels, text(frames[i])); });
    for (const auto& frame : frames) shown_.push_back(about(frame));
  }
  void commit() override { folder_.commit(shown_, facts_, digests_); }

 private:
  [[nodiscard]] ImageText text(const ProjectorFrame& frame) const {
    return {{"vam:time_s", format_number(frame.time_s, 9)}, {"vam:fps", fps_}, {"vam:history", history_}};
  }

  FrameFolder folder_;
  std::string fps_, history_, facts_;
  std::vector<model::ImageInfo> shown_;
  std::vector<Digest> digests_;
};

class StackSink : public FrameSink {
 public:
  StackSink(const std::string& path, const FrameSinkOptions& options)
      : writer_(path, options.info, options.stack), z_start_mm_(options.info.z_start_mm) {}

  void write(std::span<const ProjectorFrame> frames) override {
    for (const auto& frame : frames) {
      model::ImageInfo info = about(frame);
      info.z_mm = z_start_mm_;  // of row 0
      writer_.write(frame.intensity, info);
    }
  }
  [[nodiscard]] bool takes_intensity() const override { return true; }
  void commit() override { writer_.commit(); }

 private:
  StackWriter writer_;
  double z_start_mm_;
};

class VideoSink : public FrameSink {
 public:
  VideoSink(const std::string& path, const FrameSinkOptions& options)
      : writer_(path, {.width = options.info.width,
                       .height = options.info.height,
                       .bits = options.bits,
                       .fps = options.fps,
                       .comment = join(options.info.history, "\n"),
                       .facts = frame_facts(options.info)}) {}

  void write(std::span<const ProjectorFrame> frames) override {
    writer_.write(count_of(frames), [&](int i) -> const GreyImage& { return frames[i].levels; });
  }
  void commit() override { writer_.commit(); }

 private:
  VideoWriter writer_;
};

}  // namespace

FrameOutput frame_output(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (path == "-" || extension == ".exr") return FrameOutput::stack;
  if (extension == ".mkv" || extension == ".mp4") return FrameOutput::video;
  if (extension.empty()) return FrameOutput::folder;
  throw Error{Fault::usage,
              path + ": frames go to .exr, .mkv, .mp4 or a folder (end its name in /), not to " + extension};
}

std::unique_ptr<FrameSink> open_frame_sink(const std::string& path, const FrameSinkOptions& options) {
  switch (frame_output(path)) {
    case FrameOutput::stack:
      return std::make_unique<StackSink>(path, options);
    case FrameOutput::video:
      return std::make_unique<VideoSink>(path, options);
    default:
      return std::make_unique<FolderSink>(path, options);
  }
}

}  // namespace vam::io
