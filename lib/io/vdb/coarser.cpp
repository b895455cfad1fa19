// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vdb/coarser.hpp"

#include <algorithm>
#include <vector>

#include "base/compute/parallel.hpp"
#include "model/coarser.hpp"

namespace vam::io {

namespace {

/// Adds an eighth of every voxel of a finer slice to the coarser one that covers it.
void add(const float* fine, const model::Grid& from, float* coarse, const model::Grid& to) {
  for (int j = 0; j < from.ny; ++j) {
    float* row = coarse + static_cast<std::size_t>(j / 2) * to.nx;
    for (int i = 0; i < from.nx; ++i) row[i / 2] += 0.125F * *fine++;
  }
}

}  // namespace

SparseVolume coarser(const SparseVolume& volume) {
  constexpr int block = 8;  // as SparseVolume stores them
  const model::Grid& from = volume.grid();
  const model::Grid to = model::coarser(from);
  SparseVolume coarse(volume.name(), to);
  std::vector<float> slices(to.slice_size() * block);
  for (int k = 0; k < to.nz; k += block) {
    const int count = std::min(block, to.nz - k);
    std::fill(slices.begin(), slices.end(), 0.0F);
    parallel_for(count, [&](int n) {
      std::vector<float> fine(from.slice_size());
      for (int at = 2 * (k + n); at < std::min(2 * (k + n) + 2, from.nz); ++at) {
        volume.read_slices(at, 1, fine.data());
        add(fine.data(), from, slices.data() + static_cast<std::size_t>(n) * to.slice_size(), to);
      }
    });
    coarse.write_slices(k, count, slices.data());
  }
  coarse.prune();
  coarse.history = volume.history;
  coarse.units = volume.units;
  coarse.metadata = volume.metadata;
  return coarse;
}

}  // namespace vam::io
