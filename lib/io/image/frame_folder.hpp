// SPDX-License-Identifier: GPL-3.0-or-later
// Frames as numbered PNG files in a folder that appears whole.
#pragma once

#include <span>
#include <string>

#include "base/pixels.hpp"
#include "io/image/image_file.hpp"
#include "io/stream/output_folder.hpp"
#include "model/stack.hpp"

namespace vam::io {

/// 00000.png, 00001.png, ... and frames.csv (file,time_s,angle_deg). An older folder is replaced when it is empty or
/// holds nothing but such frames. Throws as OutputFolder does.
class FrameFolder {
 public:
  explicit FrameFolder(const std::string& path);
  /// Frame `number` from 0, in any order, from any thread.
  void write(int number, const GreyImage& frame, const ImageText& text) const;
  /// After all: when and at which angle frame i is shown.
  void commit(std::span<const model::ImageInfo> frames);

 private:
  OutputFolder folder_;
};

}  // namespace vam::io
