// SPDX-License-Identifier: GPL-3.0-or-later
// Doses of whole stacks through the vial's operator, for tests.
#pragma once

#include <span>
#include <vector>

#include "base/compute/per_slice.hpp"
#include "base/compute/slab.hpp"
#include "base/image.hpp"
#include "light/operators/private/vial_operator.hpp"

namespace parts {

inline std::vector<vam::Slab> packed(std::span<const vam::Image> images) {
  using namespace vam;
  std::vector<Slab> all = slabs((images.size() + lanes - 1) / lanes, images[0].width, images[0].height);
  for (std::size_t k = 0; k < images.size(); ++k) {
    for (std::size_t p = 0; p < images[k].size(); ++p) {
      all[k / lanes].values[p * lanes + k % lanes] = images[k].values[p];
    }
  }
  return all;
}

/// Doses of `slices` slices from sinograms of projector columns x angles, as the operator gives them.
inline std::vector<vam::Image> doses_of(const vam::light::Operator& light, std::span<const vam::Image> sinograms,
                                        std::size_t slices) {
  using namespace vam;
  const std::vector<Slab> images = packed(sinograms);
  std::vector<Slab> rows = slabs(images.size(), light.sinogram().width, light.sinogram().height);
  for (std::size_t s = 0; s < rows.size(); ++s) light.collapse(images[s], rows[s]);
  std::vector<Slab> out = slabs((slices + lanes - 1) / lanes, light.object().width, light.object().height);
  light.adjoint(rows, out);
  std::vector<Image> doses(slices, Image(light.object().width, light.object().height));
  for (std::size_t k = 0; k < slices; ++k) {
    for (std::size_t p = 0; p < doses[k].size(); ++p) {
      doses[k].values[p] = out[k / lanes].values[p * lanes + k % lanes];
    }
  }
  return doses;
}

inline vam::Image dose_of(const vam::light::VialSetup& setup, const vam::Image& sinogram) {
  return doses_of(vam::light::VialOperator(setup), {&sinogram, 1}, 1).front();
}

}  // namespace parts
