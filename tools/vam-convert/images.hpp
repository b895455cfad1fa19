// SPDX-License-Identifier: GPL-3.0-or-later
// What comes in, image by image, whatever it is kept in.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/image.hpp"
#include "io/array/array_reader.hpp"
#include "io/stream/file_type.hpp"
#include "model/stack.hpp"
#include "vam-convert/options.hpp"
#include "vam-convert/stage_angles.hpp"

namespace vam::convert_tool {

class Images {
 public:
  Images() = default;
  virtual ~Images() = default;
  Images(const Images&) = delete;
  Images& operator=(const Images&) = delete;
  [[nodiscard]] virtual io::ArraySize size() const = 0;
  /// Divided by --full-scale; false after the last.
  virtual bool next(Image& image) = 0;
  /// Do they show the projector's image, one a stage angle, row 0 at the top?
  [[nodiscard]] virtual bool are_frames() const = 0;
  /// What frames state, their printer and exposure.
  [[nodiscard]] virtual model::StackInfo stated() const { return {}; }
  /// Are the values grey levels, not intensities?
  [[nodiscard]] virtual bool are_grey() const { return false; }
  /// What frames state about their angles.
  [[nodiscard]] virtual StatedViews views() const { return {}; }
  /// The edge of the voxels that an array's file states; 0: none.
  [[nodiscard]] virtual double voxel_mm() const { return 0; }
};

/// An array with these axes for images, rows and columns; or the images of a folder or video. Throws what opening them
/// throws.
[[nodiscard]] std::unique_ptr<Images> open_source(const Options& options, std::optional<io::FileType> type,
                                                  const std::string& letters);

}  // namespace vam::convert_tool
