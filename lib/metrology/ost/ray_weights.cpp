// SPDX-License-Identifier: GPL-3.0-or-later
// Weights of the rays of a camera: their length, and what absorption has taken [physics §8].
#include <cmath>
#include <span>
#include <vector>

#include "metrology/ost/private/ost_state.hpp"
#include "model/absorption.hpp"
#include "model/circle.hpp"
#include "optics/chief_ray.hpp"

namespace vam::metrology {

/// A ray that climbs is longer than its plan by 1 / cos; light from the axis plane has the way to the wall before it.
void OstReconstructor::State::weigh(std::vector<Image>& sinograms, std::span<const double> heights_mm) const {
  const double radius_mm = optics::resin_radius_mm(eye.view);
  const double rate = climb_rate_per_mm(eye, 0);
  for (std::size_t k = 0; k < sinograms.size(); ++k) {
    const double cosine = 1 / std::hypot(1, rate * heights_mm[k]);
    for (int t = 0; t < detector.columns; ++t) {
      const double x_mm = detector.x_mm(t);
      const double way_mm = model::half_chord(radius_mm, x_mm);
      const auto weight = static_cast<float>(cosine / model::transmitted(absorption_per_mm, way_mm));
      for (int a = 0; a < sinograms[k].height; ++a) sinograms[k](t, a) *= weight;
    }
  }
}

}  // namespace vam::metrology
