#include "light/preconditioner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vam::light {

tomo::FilterSpec preconditioner_spec(const tomo::ParallelGeometry& rows) {
  constexpr double nyquist = 0.5;  // cycles per column; floor and ceiling are fractions of the gain there
  const double over_half_turn = std::numbers::pi / std::abs(rows.angle_step_rad);
  tomo::FilterSpec spec;
  spec.floor = 0.64 / rows.columns / nyquist;
  spec.ceiling = std::clamp(over_half_turn / (std::numbers::pi * rows.columns) / nyquist, spec.floor, 1.0);
  return spec;
}

}  // namespace vam::light
