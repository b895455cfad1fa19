#include "vam-curethrough/frame.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"

namespace vam::curethrough {

void to_grey(Image& slice, const resin::Response& response) {
  parallel_for(slice.height, [&](int y) {
    // Rows are long runs of few values, so the inverse is asked for once a run.
    float* row = slice.row(y);
    float intensity = -1;
    float grey = 0;
    for (int x = 0; x < slice.width; ++x) {
      if (row[x] != intensity) {
        intensity = row[x];
        grey = static_cast<float>(response.grey(static_cast<double>(intensity)));
      }
      row[x] = grey;
    }
  });
}

Frame::Frame(const model::Projector* projector, const model::StackInfo& slice, float dark)
    : whole_(projector != nullptr), columns_(slice.width), rows_(slice.height), dark_(dark) {
  if (!whole_) return;
  if (std::fabs(projector->pixel_mm - slice.pixel_mm) > 1e-3 * projector->pixel_mm) {
    throw Error{Fault::data, "--full-frame: the part's voxels of " + format_number(slice.pixel_mm) +
                                 " mm are not the projector's pixels of " + format_number(projector->pixel_mm) +
                                 " mm; slice with --voxel " + format_number(projector->pixel_mm)};
  }
  left_ = static_cast<int>(std::lround(projector->axis_column - 0.5 * (slice.width - 1)));
  top_ = static_cast<int>(std::lround(projector->axis_row - 0.5 * (slice.height - 1)));
  if (left_ < 0 || top_ < 0 || left_ + slice.width > projector->columns || top_ + slice.height > projector->rows) {
    throw Error{Fault::data, "--full-frame: the part's " + std::to_string(slice.width) + " x " +
                                 std::to_string(slice.height) + " pixels from column " + std::to_string(left_) +
                                 ", row " + std::to_string(top_) + " do not fit in " +
                                 std::to_string(projector->columns) + " x " + std::to_string(projector->rows)};
  }
  columns_ = projector->columns;
  rows_ = projector->rows;
}

void Frame::apply(model::StackInfo& info) const {
  info.width = columns_;
  info.height = rows_;
  info.z_start_mm -= top_ * info.row_mm;
}

const Image& Frame::place(const Image& slice, Image& buffer) const {
  if (!whole_) return slice;
  if (buffer.width != columns_ || buffer.height != rows_) buffer = Image(columns_, rows_, dark_);
  for (int y = 0; y < slice.height; ++y) {
    std::copy_n(slice.row(y), slice.width, buffer.row(top_ + y) + left_);
  }
  return buffer;
}

GreyImage Frame::place(const GreyImage& slice) const {
  if (!whole_) return slice;
  GreyImage picture(columns_, rows_, slice.bits);
  for (int y = 0; y < slice.height; ++y) {
    std::copy_n(slice.values.begin() + static_cast<std::ptrdiff_t>(slice.index(0, y)), slice.width,
                picture.values.begin() + static_cast<std::ptrdiff_t>(picture.index(left_, top_ + y)));
  }
  return picture;
}

}  // namespace vam::curethrough
