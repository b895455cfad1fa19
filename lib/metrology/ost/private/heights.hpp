// SPDX-License-Identifier: GPL-3.0-or-later
// Camera rows to heights in the resin, by exact rays that climb.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "metrology/ost/views.hpp"
#include "model/grid.hpp"
#include "optics/resample.hpp"

namespace vam::metrology {

/// Where the camera stands and which of its rows is level with the lens, that is at z = 0.
struct Eye {
  optics::View view;
  optics::Detector camera;
  double axis_row = 0;
  int rows = 0;

  /// Height of a row in the plane of the axis, mm.
  [[nodiscard]] double z_mm(double row) const { return (axis_row - row) * camera.pixel_mm; }
};

/// For every camera column the row whose ray passes the axis at a height: to second order in the height's square from
/// exact rays.
class RowOfHeight {
 public:
  explicit RowOfHeight(const Eye& eye);
  /// Columns whose rays miss the resin are as their nearest neighbours.
  [[nodiscard]] double row(int column, double height_mm) const;

 private:
  struct ColumnHeights {
    double linear;
    double cubic;  // height = z (linear + cubic z^2), z that of the row in the plane of the axis
  };
  Eye eye_;
  std::vector<ColumnHeights> columns_;
};

/// Heights of the grid that see the print, in ascending order; `most` is their maximum number, those nearest to the
/// height of the lens are kept: there a line is the same from either end.
[[nodiscard]] std::vector<double> print_heights(const Image& mean_view, const RowOfHeight& map, const Eye& eye,
                                                const model::Grid& grid, std::size_t most);

/// Share of its height that a ray of offset x_v gains per mm along the light; 0 where rays stay level.
[[nodiscard]] double climb_rate_per_mm(const Eye& eye, double x_v_mm);

/// The pixels of a row or column of `size`, four at least, that make the value between them, by cubic convolution
/// [KEYS81]: all in the image, beyond which its last is repeated.
struct FourTaps {
  int first;
  std::array<float, 4> weights;
};
[[nodiscard]] FourTaps four_taps(double at, int size);

/// Samples an image of `columns` x `rows`, four at least, turned about the axis by its tilt.
class LevelRows {
 public:
  /// At these heights, lowest first.
  LevelRows(const RowOfHeight& map, int columns, int rows, std::span<const double> heights_mm, const AxisPose& axis);
  /// At so many heights, the row of each in a column given by row_of(column, height).
  LevelRows(int columns, int rows, int heights, const AxisPose& axis,
            const std::function<double(int column, int height)>& row_of);
  [[nodiscard]] Image of(const Image& image) const;

 private:
  struct PixelTaps {
    std::size_t first;  // of 4 x 4 pixels, all in the image
    std::array<float, 4> right;
    std::array<float, 4> down;
  };
  int columns_;
  int heights_;
  std::vector<PixelTaps> taps_;  // [height][column]
};

}  // namespace vam::metrology
