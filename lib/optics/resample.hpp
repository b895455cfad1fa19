// SPDX-License-Identifier: GPL-3.0-or-later
// Resampling between the ideal parallel-beam ("virtual") sinogram and the columns of a real projector or camera.
// [RAY21 eq 3, OST22 eq 1]; the way back [OST22 eq 5, OST22 eq 6, OST22 eq 7, OST22 eq 8, OST22 eq 9; physics §3].
#pragma once

#include <span>
#include <vector>

#include "base/image.hpp"
#include "optics/chief_ray.hpp"

namespace vam::optics {

enum class Interpolation { linear, cubic };

/// Columns of a detector: column c is at (c - axis_column) * pixel_mm in the plane of the axis.
struct Detector {
  int columns = 0;
  double pixel_mm = 0;
  double axis_column = 0;

  [[nodiscard]] double x_mm(double column) const { return (column - axis_column) * pixel_mm; }
  [[nodiscard]] double column(double x_mm) const { return x_mm / pixel_mm + axis_column; }
};

/// A detector with the axis in the middle, as every virtual sinogram has it.
[[nodiscard]] inline Detector centred_detector(int columns, double pixel_mm) {
  return {columns, pixel_mm, 0.5 * (columns - 1)};
}

/// Rows of a sinogram: row a is at stage angle start_rad + a * step_rad. One turn by default.
struct Turn {
  int rows = 0;
  double start_rad = 0;
  double step_rad = 0;
};

struct ResampleOptions {
  Interpolation interpolation = Interpolation::cubic;
  bool fresnel = true;          // to projector: divide by T; to virtual: divide by T (light lost on the way out)
  bool jacobian = true;         // to projector: multiply by J; to virtual: divide by J
  double angle_offset_rad = 0;  // the part stands at stage angle + this
  int direction = 1;            // -1: the vial turns the other way, the part stands at minus the stage angle
  bool keep_negative = true;    // false: results below 0 (overshoot of the cubic) become 0
};

/// Where one output column comes from: a few input columns, and a shift along the angles.
struct ColumnSource {
  int first = 0;            // first input column
  int count = 0;            // 0: the ray misses or falls outside; the column is 0
  std::size_t weights = 0;  // of its first weight in ResamplePlan::weights; J/T is in them
  int row = 0;              // input row of output row 0's first angular tap, in [0, rows)
  float angle_weights[4] = {0, 0, 0, 0};
};

/// The map of one geometry, made once and applied to every slice.
struct ResamplePlan {
  int columns_in = 0;
  int columns_out = 0;
  int rows = 0;
  int sense = 1;  // input rows per output row, +1 or -1
  bool keep_negative = true;
  Turn rows_out;
  std::vector<ColumnSource> sources;  // one per output column
  std::vector<float> weights;
};

/// One column of the map, for people (vam-resample --explain).
struct MapPoint {
  double x_p_mm = 0;
  ChiefRay ray;
  double weight = 0;  // J/T as the options ask for; 0 where the ray misses
};
[[nodiscard]] MapPoint map_point(const View& view, double x_p_mm, const ResampleOptions& options);

/// Virtual -> projector: S_p(x_p, theta) = S_v(x_v, theta + delta) J / T. Rows of the output: the same rows;
/// options.direction says which way the vial turns past them. Throws Fault::data unless the rows cover one turn.
[[nodiscard]] ResamplePlan plan_to_projector(const View& view, const Detector& virtual_, const Detector& projector,
                                             const Turn& turn, const ResampleOptions& options);

/// Camera (or projector) -> virtual, the inverse map: S_v(x_v, theta) = S_c(x_c, theta - delta). A coarser output is
/// low-passed by the width of its columns. Output rows are part angles, from start_rad upwards in |step|.
/// Throws Fault::data unless the rows cover one turn.
[[nodiscard]] ResamplePlan plan_to_virtual(const View& view, const Detector& camera, const Detector& virtual_,
                                           const Turn& turn, const ResampleOptions& options);

/// Applies the plan to slices, 16 side by side. Inputs are columns_in x rows; outputs are resized to columns_out x
/// rows. Throws Fault::data where an input has another shape.
void resample(const ResamplePlan& plan, std::span<const Image> in, std::span<Image> out);

}  // namespace vam::optics
