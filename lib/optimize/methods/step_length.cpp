// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/methods/step_length.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam::optimize {

namespace {
constexpr int iterations = 6;  // within 5 % by then
constexpr double spare = 1.05;
/// The slice with most voxels that light reaches, the first of several; an insert may fill others.
std::size_t fullest_slice(const Problem& problem) {
  std::vector<std::int64_t> voxels(problem.labels.size() * lanes, 0);
  parallel_for(count_of(problem.labels), [&](int s) {
    const auto& labels = problem.labels[s];
    for (std::size_t i = 0; i < labels.size(); ++i)
      voxels[static_cast<std::size_t>(s) * lanes + i % lanes] += labels[i] != Label::outside ? 1 : 0;
  });
  return static_cast<std::size_t>(std::max_element(voxels.begin(), voxels.end()) - voxels.begin());
}

}  // namespace

// A* P A on the object side has the same eigenvalues. The start has something of every frequency: a few points.
double largest_eigenvalue(const light::Operator& light, const Problem& problem) {
  const std::size_t slice = fullest_slice(problem);
  const std::size_t lane = slice % lanes;
  const auto& labels = problem.labels[slice / lanes];
  const light::Shape shape = light.object();
  const std::size_t slab = slice / lanes;
  const light::SlabRange lit = light.lit_by({slab, slab + 1});
  std::vector<Slab> sinograms = slabs(lit.end - lit.first, light.sinogram().width, light.sinogram().height);
  Slab object(shape.width, shape.height);
  for (int y = 0; y < shape.height; ++y) {
    for (int x = 0; x < shape.width; ++x) {
      const bool point = (x * 7 + y * 13) % 31 == 0;
      object.at(x, y)[lane] = point ? 1.0F : 0.1F;
    }
  }
  const auto norm_inside = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < object.values.size(); ++i) {
      float& v = object.values[i];
      if (labels[i / lanes * lanes + lane] == Label::outside) v = 0.0F;
      sum += static_cast<double>(v) * static_cast<double>(v);
    }
    return std::sqrt(sum);
  };
  double norm = norm_inside();
  if (norm == 0 || sinograms.empty()) return 1;
  for (int i = 0; i < iterations; ++i) {
    const auto unit = static_cast<float>(1.0 / norm);
    for (float& v : object.values) v *= unit;
    light.forward_within({slab, {&object, 1}}, {lit.first, sinograms});
    light.precondition(sinograms);
    light.adjoint_within({lit.first, sinograms}, {slab, {&object, 1}});
    norm = norm_inside();
    if (norm == 0) return 1;
  }
  return norm * spare;
}

}  // namespace vam::optimize
