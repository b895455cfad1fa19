// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/axis_transmission.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "model/circle.hpp"

namespace vam::tomo {

void require_translucent(double mu_per_px, double resin_radius_px) {
  constexpr double deepest = 40;  // e^40 squared is a float
  const double depth = mu_per_px * resin_radius_px;
  if (depth <= deepest) return;
  throw Error{Fault::data, "resin.absorption_per_mm: the intensity falls to e^-" + format_number(depth, 3) +
                               " of its value on the way to the axis, and e^-" + format_number(deepest) +
                               " is the supported limit; absorption is per mm and to base e (ln 10 times absorbance)"};
}

std::vector<float> to_the_axis(int columns, double rate_per_px, double resin_radius_px) {
  std::vector<float> factor;
  for (int c = 0; c < columns; ++c) {
    const double t = c - 0.5 * (columns - 1);
    factor.push_back(static_cast<float>(std::exp(rate_per_px * model::half_chord(resin_radius_px, t))));
  }
  return factor;
}

}  // namespace vam::tomo
