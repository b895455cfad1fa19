// Where a slice lies in the projector's picture, and what grey shows it.
#pragma once

#include "base/image.hpp"
#include "base/pixels.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "resin/response.hpp"

namespace vam::curethrough {

/// Intensities, fractions of the maximum, to grey 0..1.
void to_grey(Image& slice, const resin::Response& response);

/// Puts slices into the projector's picture, the part's axis at (axis_column, axis_row), or leaves them as they are.
class Frame {
 public:
  /// projector null: as they are. Throws Fault::data when the part's voxels are not the projector's pixels, or the part
  /// is larger than the picture. `dark` is the value of pixels around the part in a stack.
  Frame(const model::Projector* projector, const model::StackInfo& slice, float dark);
  /// Size and place of the pictures into the stack's facts.
  void apply(model::StackInfo& info) const;
  /// Returns the slice or, if it has to be placed, `buffer` with the slice in it.
  [[nodiscard]] const Image& place(const Image& slice, Image& buffer) const;
  [[nodiscard]] GreyImage place(const GreyImage& slice) const;

 private:
  bool whole_ = false;
  int columns_ = 0;
  int rows_ = 0;
  int left_ = 0;
  int top_ = 0;
  float dark_ = 0;
};

}  // namespace vam::curethrough
