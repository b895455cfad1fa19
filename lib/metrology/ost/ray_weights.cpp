// SPDX-License-Identifier: GPL-3.0-or-later
// Weights of the rays of a camera: their length, and what absorption has taken [physics §8].
#include <cmath>
#include <span>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "metrology/ost/private/ost_state.hpp"
#include "model/absorption.hpp"
#include "model/circle.hpp"
#include "optics/chief_ray.hpp"

namespace vam::metrology {

/// A ray that climbs is longer than its plan by 1 / cos; light from the axis plane has the way to the wall before it.
void OstReconstructor::State::weigh(std::vector<Image>& sinograms, std::span<const double> heights_mm) const {
  const double radius_mm = optics::resin_radius_mm(eye.view);
  const double rate = climb_rate_per_mm(eye, 0);
  std::vector<double> lost;
  for (int t = 0; t < detector.columns; ++t) {
    lost.push_back(1 / model::transmitted(absorption_per_mm, model::half_chord(radius_mm, detector.x_mm(t))));
  }
  parallel_for(count_of(sinograms), [&](int k) {
    Image& s = sinograms[k];
    const double cosine = 1 / std::hypot(1, rate * heights_mm[k]);
    std::vector<float> weight(s.width);
    for (int t = 0; t < s.width; ++t) weight[t] = static_cast<float>(cosine * lost[t]);
    for (int a = 0; a < s.height; ++a) {
      float* row = s.row(a);
      for (int t = 0; t < s.width; ++t) row[t] *= weight[t];
    }
  });
}

}  // namespace vam::metrology
