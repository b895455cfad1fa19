// SPDX-License-Identifier: GPL-3.0-or-later
// Where projector frames go: a folder of PNG, an EXR stack, a video; a live display is one more.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "base/image.hpp"
#include "base/pixels.hpp"
#include "io/exr/stack.hpp"
#include "model/stack.hpp"

namespace vam::io {

/// One frame, oriented as the device wants it.
struct ProjectorFrame {
  GreyImage levels;      // to send
  Image intensity;       // what is wanted, as a fraction of full intensity
  double time_s = 0;     // of the middle of its showing, from frame 0
  double angle_deg = 0;  // stage angle at that time
};

class FrameSink {
 public:
  FrameSink() = default;
  virtual ~FrameSink() = default;
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;
  /// The next frames, in order. Throws Error: no_output, io.
  virtual void write(std::span<const ProjectorFrame> frames) = 0;
  /// Whether the frames must have their intensity, beside the levels.
  [[nodiscard]] virtual bool takes_intensity() const { return false; }
  /// After the last one; what was written appears under its name, whole. If it is not called, nothing is left.
  virtual void commit() = 0;
};

enum class FrameOutput { folder, stack, video };

/// By name: "-" and .exr are an EXR stack; .mkv and .mp4 a video; a name without an ending, or that ends in /, a
/// folder. Throws Fault::usage for any other ending.
[[nodiscard]] FrameOutput frame_output(const std::string& path);

/// What the sinks need to know beforehand. The EXR stack takes its facts from `info`; the video its rate from `fps`.
struct FrameSinkOptions {
  model::StackInfo info;
  double fps = 0;
  int bits = 8;
  StackOptions stack;
};

/// A folder is a FrameFolder. Throws Error: no_output.
[[nodiscard]] std::unique_ptr<FrameSink> open_frame_sink(const std::string& path, const FrameSinkOptions& options);

}  // namespace vam::io
