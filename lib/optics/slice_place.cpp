// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/slice_place.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"

namespace vam::optics {

SlicePlace::SlicePlace(const model::StackInfo& slice) : columns_(slice.width), rows_(slice.height) {}

SlicePlace::SlicePlace(const std::string& subject, const model::Projector& projector, const model::StackInfo& slice,
                       double column_offset, double row_offset)
    : columns_(projector.columns), rows_(projector.rows) {
  if (slice.pixel_mm > 0 && std::fabs(projector.pixel_mm - slice.pixel_mm) > 1e-3 * projector.pixel_mm) {
    throw Error{Fault::data, subject + ": the part's voxels of " + format_number(slice.pixel_mm) +
                                 " mm are not the projector's pixels of " + format_number(projector.pixel_mm) +
                                 " mm; slice with voxels of " + format_number(projector.pixel_mm) + " mm"};
  }
  const bool whole = as_it_is(slice.width, slice.height);
  const double left = whole ? 0 : projector.axis_column - 0.5 * (slice.width - 1);
  const double top = whole ? 0 : projector.axis_row - 0.5 * (slice.height - 1);
  left_ = round_int(left + column_offset);
  top_ = round_int(top + row_offset);
  if (left_ < 0 || top_ < 0 || left_ + slice.width > columns_ || top_ + slice.height > rows_) {
    throw Error{Fault::data, subject + ": the part's " + std::to_string(slice.width) + " x " +
                                 std::to_string(slice.height) + " pixels from column " + std::to_string(left_) +
                                 ", row " + std::to_string(top_) + " do not fit in " + std::to_string(columns_) +
                                 " x " + std::to_string(rows_)};
  }
}

void SlicePlace::apply(model::StackInfo& info) const {
  info.width = columns_;
  info.height = rows_;
  info.z_start_mm -= top_ * info.row_mm;
}

const Image& SlicePlace::place(const Image& slice, float dark, Image& buffer) const {
  if (as_it_is(slice.width, slice.height)) return slice;
  if (!as_it_is(buffer.width, buffer.height)) buffer = Image(columns_, rows_, dark);
  for (int y = 0; y < slice.height; ++y) {
    std::copy_n(slice.row(y), slice.width, buffer.row(top_ + y) + left_);
  }
  return buffer;
}

GreyImage SlicePlace::place(const GreyImage& slice) const {
  if (as_it_is(slice.width, slice.height)) return slice;
  GreyImage image(columns_, rows_, slice.bits);
  for (int y = 0; y < slice.height; ++y) {
    std::copy_n(slice.values.begin() + static_cast<std::ptrdiff_t>(slice.index(0, y)), slice.width,
                image.values.begin() + static_cast<std::ptrdiff_t>(image.index(left_, top_ + y)));
  }
  return image;
}

}  // namespace vam::optics
