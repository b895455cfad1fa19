// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/misses.hpp"

#include <algorithm>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam::optimize {

namespace {

/// visit(slice, pixel, dose, label) for every voxel of the slices in use, each slice by one thread.
template <class Visit>
void for_each_voxel(std::span<const Slab> dose, const Problem& problem, const Visit& visit) {
  parallel_for(problem.slices, [&](int slice) {
    const auto s = static_cast<std::size_t>(slice) / lanes;
    for (std::size_t i = static_cast<std::size_t>(slice) % lanes; i < dose[s].values.size(); i += lanes) {
      visit(slice, i / lanes, dose[s].values[i], problem.labels[s][i]);
    }
  });
}

}  // namespace

StraySlices outside_part(std::span<const Slab> dose, const Problem& problem, const model::VoxelBox& box) {
  const auto count = static_cast<std::size_t>(problem.slices);
  StraySlices slices{std::vector<model::StrayCure>(count), std::vector<model::StrayCure>(count)};
  const double threshold = problem.demands.window.threshold();
  const auto width = static_cast<std::size_t>(dose.empty() ? 1 : dose[0].width);
  for_each_voxel(dose, problem, [&](std::size_t slice, std::size_t pixel, float value, Label label) {
    if (label != Label::void_) return;
    const auto x = static_cast<int>(pixel % width);
    const auto y = static_cast<int>(pixel / width);
    slices.whole[slice].add(value, threshold);
    if (!box.contains(x, y, box.low[2])) slices.beside[slice].add(value, threshold);
  });
  return slices;
}

std::vector<std::int64_t> wrong_voxels(std::span<const Slab> dose, const Problem& problem) {
  std::vector<std::int64_t> slices(problem.slices, 0);
  const auto threshold = static_cast<float>(problem.demands.window.threshold());
  for_each_voxel(dose, problem, [&](std::size_t slice, std::size_t, float value, Label label) {
    if (is_constrained(label) && (value >= threshold) != (label == Label::part)) ++slices[slice];
  });
  return slices;
}

void count_pieces(std::span<const Slab> dose, const Problem& problem, int first, int last, const VolumeSource& source,
                  int from, verdict::PrintPieceCounter& counter) {
  constexpr std::size_t few_voxels = std::size_t{1} << 19U;  // light that fills the memory leaves room for few
  const std::size_t size = product(dose[0].width, dose[0].height);
  const int at_once = static_cast<int>(std::clamp<std::size_t>(few_voxels / size, 1, lanes));
  std::vector<float> doses, target;
  for (int k = first, count = 0; k < last; k += count) {
    const std::size_t s = static_cast<std::size_t>(k) / lanes;
    count = std::min({at_once, last - k, lanes - k % lanes});
    doses.resize(product(count, size));
    target.resize(doses.size());
    for (std::size_t i = 0; i < size; ++i) {
      for (int n = 0; n < count; ++n) {
        const std::size_t at = i * lanes + static_cast<std::size_t>(k % lanes + n);
        doses[product(n, size) + i] = problem.labels[s][at] == Label::outside ? 0 : dose[s].values[at];
      }
    }
    source.target(from + k, count, target.data());
    counter.add(doses.data(), target.data(), count);
  }
}

}  // namespace vam::optimize
