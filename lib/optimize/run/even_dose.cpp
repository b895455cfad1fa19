#include "optimize/run/private/even_dose.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/per_slice.hpp"

namespace vam::optimize {

namespace {

std::vector<Slab> dose_of_even_light(const light::Operator& light, int slices) {
  const auto count = static_cast<std::size_t>((slices + lanes - 1) / lanes);
  Slab even(light.image().width, light.image().height);
  std::fill(even.values.begin(), even.values.end(), 1.0F);
  std::vector<Slab> sinograms = slabs(count, light.sinogram().width, light.sinogram().height);
  for (Slab& slab : sinograms) light.collapse(even, slab);
  std::vector<Slab> dose = slabs(count, light.object().width, light.object().height);
  light.adjoint(sinograms, dose);
  return dose;
}

}  // namespace

EvenDose even_dose(const light::Operator& light, const model::Circle& circle, int slices) {
  const std::vector<Slab> dose = dose_of_even_light(light, slices);
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
