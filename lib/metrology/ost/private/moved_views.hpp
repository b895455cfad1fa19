// SPDX-License-Identifier: GPL-3.0-or-later
// The views of a fit to line pairs, and their lines after a motion.
#pragma once

#include <array>
#include <vector>

#include "base/image.hpp"
#include "base/index.hpp"
#include "metrology/ost/private/line_pairs.hpp"
#include "metrology/ost/private/ray_mask.hpp"

namespace vam::metrology {

/// All that a fit needs of the views after some motion.
struct Lines {
  std::vector<Image> now;
  std::array<std::vector<Image>, pair_unknowns> by;  // one unit of each unknown
  PairVector by_at{};                                // the motion after which those are
  RayMask hidden;                                    // by specks at either end, [height][column]

  [[nodiscard]] bool is_seen(int k, int t) const { return hidden[product(k, now.front().width) + t] == 0; }
};

/// Blurred, so that no edge is sharper than what is sampled between the angles. basis and sinograms_of are referred to.
class MovedViews {
 public:
  MovedViews(const std::vector<Image>& level, const PairBasis& basis, const SinogramsOf& sinograms_of);
  [[nodiscard]] Lines lines(const PairVector& value) const;
  /// The effect of a unit of motion is kept while the motion is close to that at which it was computed.
  void move(const PairVector& value, Lines& lines) const;

 private:
  const PairBasis& basis_;
  const SinogramsOf& sinograms_of_;
  std::vector<Image> blurred_;
  RayMask hidden_;
};

}  // namespace vam::metrology
