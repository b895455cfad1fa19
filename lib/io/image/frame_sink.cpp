// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/frame_sink.hpp"

#include <filesystem>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "io/image/frame_folder.hpp"
#include "io/image/video.hpp"

namespace vam::io {

namespace {

model::ImageInfo about(const ProjectorFrame& frame) {
  model::ImageInfo info;
  info.angle_deg = frame.angle_deg;
  info.has_angle = true;
  info.time_s = frame.time_s;
  info.has_time = true;
  return info;
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
  void commit() override { folder_.commit(shown_, facts_ + frame_seal(facts_, digests_)); }

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
