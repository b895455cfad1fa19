// SPDX-License-Identifier: GPL-3.0-or-later
// How far the light of a pixel spreads about its chief ray: by the aperture of the lens, and across the columns by the
// turning of the stage while a frame is shown [physics §4].
#pragma once

#include <vector>

#include "light/rays/vial_setup.hpp"

namespace vam::light {

class LightSpread {
 public:
  /// No spread at all.
  LightSpread() = default;
  explicit LightSpread(const VialSetup& setup);

  [[nodiscard]] bool across() const { return hold_rad_ > 0 || half_angle_rad_ > 0; }
  [[nodiscard]] bool along() const { return rows_half_angle_rad_ > 0; }
  /// At depth u of the level ray of column x_p, where neighbouring columns are 1 / `columns_per_mm` apart: the square
  /// of the edge of the box that has the variance of the spread, in columns^2.
  [[nodiscard]] float across2(float x_p_mm, float u_mm, float columns_per_mm) const;
  /// Its standard deviation along z there, in mm of the resin.
  [[nodiscard]] float along_mm(float x_p_mm, float u_mm) const;

 private:
  /// Across: (slope u + start)^2 is the aperture's; along: |slope u + start| is.
  struct Line {
    float start = 0, slope = 0;
    [[nodiscard]] float at(float u_mm) const { return start + slope * u_mm; }
  };
  struct Column {
    Line across, along;
  };
  [[nodiscard]] const Column& column(float x_p_mm) const;

  double hold_rad_ = 0, half_angle_rad_ = 0, rows_half_angle_rad_ = 0;
  float first_mm_ = 0, per_mm_ = 0;
  std::vector<Column> columns_;  // at equal distances, from first_mm_ on
};

}  // namespace vam::light
