// SPDX-License-Identifier: GPL-3.0-or-later
// How often the solid of a field is pierced: its Euler characteristic, pieces - tunnels + cavities.
#pragma once

#include <cstdint>
#include <vector>

namespace vam::model {

/// Of where a field, linear in x, y and z between the centres of voxels, reaches a level > 0; slice by slice. The field
/// is looked at every half voxel, where the solid is the union of cubes: those that touch are of one piece. Beyond the
/// volume it is 0.
class EulerCounter {
 public:
  EulerCounter(int width, int height, double level) : width_(width), height_(height), level_(level) {}
  /// The next slices, row-major. `slices` of width x height values one after the other.
  void add(int count, const float* slices);
  /// Of the slices so far.
  [[nodiscard]] std::int64_t characteristic() const;

 private:
  [[nodiscard]] std::int64_t between(const float* below, const float* above) const;

  int width_, height_;
  double level_;
  std::vector<float> last_;  // empty: there is none
  std::int64_t sum_ = 0;     // below the last
};

}  // namespace vam::model
