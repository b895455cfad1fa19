// SPDX-License-Identifier: GPL-3.0-or-later
// Stacks, videos and folders of images, read in the same way.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "io/exr/stack.hpp"
#include "io/stream/file_type.hpp"

namespace vam::io {

/// Images one after the other. Of a video or a folder the values are grey as a fraction of full, of a folder of EXR
/// images intensities as they are, and the pitches in info are 0.
class ImageSource {
 public:
  ImageSource() = default;
  virtual ~ImageSource() = default;
  ImageSource(const ImageSource&) = delete;
  ImageSource& operator=(const ImageSource&) = delete;
  [[nodiscard]] virtual const model::StackInfo& info() const = 0;
  /// The facts of every image, where they are known before the first is read; else empty.
  [[nodiscard]] virtual std::vector<model::ImageInfo> about() const { return {}; }
  virtual bool next(Image& image, model::ImageInfo& about) = 0;
  /// Of a video: when each is shown, and when the last one ends [video_frame_times()]; empty for others.
  [[nodiscard]] virtual std::vector<double> times_s() const { return {}; }
  /// Are the values grey levels, which a projector's response makes intensities of?
  [[nodiscard]] virtual bool is_grey() const { return false; }
  /// True if all of it has hashes, which are verified on reading.
  [[nodiscard]] virtual bool is_sealed() const { return false; }
  /// The first 16 digits of that of a video; empty for others.
  [[nodiscard]] virtual std::string seal() const { return ""; }
  /// True if the container's checksums are valid; of a video of any program.
  [[nodiscard]] virtual bool has_checksums() const { return false; }
};

/// type: stack, video or images. Throws Error: no_input, data.
[[nodiscard]] std::unique_ptr<ImageSource> open_images(const std::string& path, FileType type);

}  // namespace vam::io
