// SPDX-License-Identifier: GPL-3.0-or-later
// Frames as numbered PNG files in a folder that appears whole.
#pragma once

#include <span>
#include <string>

#include "base/pixels.hpp"
#include "io/image/image_file.hpp"
#include "io/stream/output_folder.hpp"
#include "io/stream/seal.hpp"
#include "model/stack.hpp"

namespace vam::io {

/// What frames state beside their pixels, where a format has no attributes: those of the stack and its
/// vam:angle_step_deg, the last, a line each, "vam:printer ...".
[[nodiscard]] std::string frame_facts(const model::StackInfo& info);
/// Takes them into `info`. Throws Fault::data, beginning with `name`, for other lines, and where the step is no angle
/// or not the last, as of a text that was cut off.
void take_frame_facts(const std::string& text, model::StackInfo& info, const std::string& name);

/// The last line of facts.txt: the seal of the lines before it and of the bytes of every frame.
[[nodiscard]] std::string frame_seal(const std::string& facts, std::span<const Digest> frames);

/// 00000.png, 00001.png, ..., frames.csv (file,time_s,angle_deg) and facts.txt (frame_facts() and its seal). An older
/// folder is replaced when it is empty or holds nothing but such frames. Throws as OutputFolder does.
class FrameFolder {
 public:
  explicit FrameFolder(const std::string& path);
  /// Frame `number` from 0, in any order, from any thread; the hash of its bytes.
  Digest write(int number, const GreyImage& frame, const ImageText& text) const;
  /// After all: when and at which angle frame i is shown, and what facts.txt holds.
  void commit(std::span<const model::ImageInfo> frames, const std::string& facts = "");

 private:
  OutputFolder folder_;
};

}  // namespace vam::io
