// SPDX-License-Identifier: GPL-3.0-or-later
// The uncertainty of a reconstruction: noise through the same reconstruction [physics §8].
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "metrology/ost/private/ost_state.hpp"
#include "metrology/ost/view_noise.hpp"

namespace vam::metrology {

namespace {

constexpr int reach = 4;  // voxels either side

// Sums over 2 reach + 1 neighbours of a line of values, `stride` apart.
void sum_line(float* values, int count, std::ptrdiff_t stride, std::vector<double>& running) {
  running.assign(static_cast<std::size_t>(count) + 1, 0.0);
  for (int i = 0; i < count; ++i) running[i + 1] = running[i] + static_cast<double>(values[i * stride]);
  for (int i = 0; i < count; ++i) {
    values[i * stride] = static_cast<float>(running[std::min(count, i + reach + 1)] - running[std::max(0, i - reach)]);
  }
}

void sum_neighbours(model::Volume& volume) {
  const model::Grid& g = volume.grid;
  const auto row = static_cast<std::ptrdiff_t>(g.nx);
  parallel_for(g.nz, [&](int k) {
    std::vector<double> running;
    for (int j = 0; j < g.ny; ++j) sum_line(volume.slice(k) + j * row, g.nx, 1, running);
    for (int i = 0; i < g.nx; ++i) sum_line(volume.slice(k) + i, g.ny, row, running);
  });
  const auto slice = static_cast<std::ptrdiff_t>(g.slice_size());
  parallel_for(g.ny, [&](int j) {
    std::vector<double> running;
    for (int i = 0; i < g.nx; ++i) sum_line(volume.slice(0) + j * row + i, g.nz, slice, running);
  });
}

/// Mean product of neighbours `step` apart, along x (as along y) or along z, over the mean square.
double correlation(const model::Volume& noise, bool along_z) {
  const model::Grid& g = noise.grid;
  const std::size_t step = along_z ? g.slice_size() : 1;
  double products = 0;
  double squares = 0;
  for (std::size_t i = 0; i + step < noise.values.size(); ++i) {
    const auto here = static_cast<double>(noise.values[i]);
    products += here * static_cast<double>(noise.values[i + step]);
    squares += here * here;
  }
  return squares > 0 ? std::clamp(products / squares, 0.0, 1.0) : 0.0;
}

}  // namespace

VoxelUncertainty OstReconstructor::uncertainty(std::span<const CameraView> views) const {
  auto state = std::make_unique<State>(*state_);
  state->options.clean = false;
  state->options.non_negative = false;
  state->options.mlem_iterations = 0;
  const OstReconstructor plain(std::move(state));
  const ViewNoise noise = view_noise(views);
  constexpr int draws = 2;
  VoxelUncertainty found;
  model::Volume squares{grid(), std::vector<float>(grid().size())};
  model::Volume inside = squares;
  for (int draw = 0; draw < draws; ++draw) {
    const model::Volume one = plain.reconstruct(noise_views(views, noise, static_cast<std::uint64_t>(draw) + 1));
    if (draw == 0) found = {{}, correlation(one, false), correlation(one, true)};
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      squares.values[i] += one.values[i] * one.values[i];
      if (draw == 0 && one.values[i] != 0) inside.values[i] = 1;
    }
  }
  model::Volume seen = inside;
  sum_neighbours(squares);
  sum_neighbours(seen);
  for (std::size_t i = 0; i < squares.values.size(); ++i) {
    float& value = squares.values[i];
    value = inside.values[i] > 0 ? std::sqrt(std::max(0.0F, value) / (draws * seen.values[i])) : 0.0F;
  }
  found.sigma = std::move(squares);
  return found;
}

}  // namespace vam::metrology
