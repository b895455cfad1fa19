// SPDX-License-Identifier: GPL-3.0-or-later
// Position of a part's slice in the projector's image.
#pragma once

#include <string>

#include "base/image.hpp"
#include "base/pixels.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"

namespace vam::optics {

/// Puts slices into the projector's image, their middle at (axis_column, axis_row); those that have the image's
/// size already stay where they are. Or, without a projector, leaves slices as they are.
class SlicePlace {
 public:
  /// As they are.
  explicit SlicePlace(const model::StackInfo& slice);
  /// `subject` begins messages; the offsets move right and down, by whole pixels. A pixel_mm of 0 is not known. Throws
  /// Fault::data when the slices' pixels are not the projector's, or lie beyond the image.
  SlicePlace(const std::string& subject, const model::Projector& projector, const model::StackInfo& slice,
             double column_offset = 0, double row_offset = 0);

  /// Size and place of the images into the stack's facts.
  void apply(model::StackInfo& info) const;
  /// Returns the slice or, if it has to be placed, `buffer` with the slice in it and `dark` around it.
  [[nodiscard]] const Image& place(const Image& slice, float dark, Image& buffer) const;
  [[nodiscard]] GreyImage place(const GreyImage& slice) const;

 private:
  [[nodiscard]] bool as_it_is(int width, int height) const { return width == columns_ && height == rows_; }
  int columns_ = 0;
  int rows_ = 0;
  int left_ = 0;
  int top_ = 0;
};

}  // namespace vam::optics
