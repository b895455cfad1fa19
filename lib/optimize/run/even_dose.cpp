// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/even_dose.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace vam::optimize {

EvenDose even_dose(const light::Operator& light, const model::Circle& circle, int slices) {
  const std::vector<Slab> dose = light::dose_of_even_light(light, (slices + lanes - 1) / lanes);
  EvenDose result;
  double sum = 0;
  std::int64_t voxels = 0;
  for (int y = 0; y < light.object().height; ++y) {
    for (int x = 0; x < light.object().width; ++x) {
      if (!circle.contains(x, y)) continue;
      for (int k = 0; k < slices; ++k) {
        const auto here = static_cast<double>(dose[k / lanes].at(x, y)[k % lanes]);
        sum += here;
        result.largest = std::max(result.largest, here);
      }
      voxels += slices;
    }
  }
  result.mean = voxels > 0 ? sum / static_cast<double>(voxels) : 0;
  return result;
}

}  // namespace vam::optimize
