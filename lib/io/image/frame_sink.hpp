// SPDX-License-Identifier: GPL-3.0-or-later
// Where projector frames go: a folder of numbered PNG, an EXR stack, a video; a live display is one more.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "base/pixels.hpp"
#include "io/exr/stack.hpp"
#include "io/image/image_file.hpp"
#include "io/stream/seal.hpp"
#include "io/stream/stream.hpp"
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

/// What frames state beside their pixels, where a format has no attributes: those of the stack and its
/// vam:angle_step_deg, the last, a line each, "vam:printer ...".
[[nodiscard]] std::string frame_facts(const model::StackInfo& info);
/// Takes them into `info`. Throws Fault::data, beginning with `name`, for other lines, and where the step is no angle
/// or not the last, as of a text that was cut off.
void take_frame_facts(const std::string& text, model::StackInfo& info, const std::string& name);

/// The last line of facts.txt: the seal of the lines before it and of the bytes of every frame and of frames.csv.
[[nodiscard]] std::string frame_seal(const std::string& facts, std::span<const Digest> files);

/// 00000.png, 00001.png, ..., frames.csv (file,time_s,angle_deg) and facts.txt (frame_facts() and its seal). An older
/// folder is replaced when it is empty or holds nothing but such frames. Throws as OutputFolder does.
class FrameFolder {
 public:
  explicit FrameFolder(const std::string& path);
  /// Frame `number` from 0, in any order, from any thread; the hash of its bytes.
  Digest write(int number, const GreyImage& frame, const ImageText& text) const;
  /// After all: when and at which angle frame i is shown; the facts, none or with the hash of each frame.
  void commit(std::span<const model::ImageInfo> frames, const std::string& facts = "",
              std::vector<Digest> digests = {});

 private:
  OutputFolder folder_;
};

}  // namespace vam::io
