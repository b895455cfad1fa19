// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/dose/grey_share.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "model/dose/dose_metrics.hpp"

namespace vam::model {

namespace {

// A slice within a margin of void, as are those below and above the grid.
using Slice = std::vector<float>;

bool is_grey(float value) { return label_of(value) == Label::surface; }

bool is_grey_around(const std::array<Slice, 3>& slices, std::size_t at, std::size_t width) {
  for (const Slice& slice : slices) {
    for (const std::size_t row : {at - width, at, at + width}) {
      if (!is_grey(slice[row - 1]) || !is_grey(slice[row]) || !is_grey(slice[row + 1])) return false;
    }
  }
  return true;
}

}  // namespace

double grey_share(const Grid& grid, const std::function<void(int k, float* out)>& read) {
  const std::size_t width = product(grid.nx, 1) + 2;
  std::array<Slice, 3> slices;  // below, here, above
  slices.fill(Slice(width * (product(grid.ny, 1) + 2), 0.0F));
  std::vector<float> plain(grid.slice_size());
  const auto load = [&](int k, Slice& slice) {
    if (k >= grid.nz) return slice.assign(slice.size(), 0.0F);
    read(k, plain.data());
    for (int j = 0; j < grid.ny; ++j) {
      std::copy_n(plain.data() + product(j, grid.nx), grid.nx, slice.data() + (j + 1) * width + 1);
    }
  };
  std::int64_t covered = 0;
  std::int64_t grey = 0;
  load(0, slices[2]);
  for (int k = 0; k < grid.nz; ++k) {
    std::swap(slices[0], slices[1]);
    std::swap(slices[1], slices[2]);
    load(k + 1, slices[2]);
    std::vector<std::array<std::int64_t, 2>> rows(grid.ny);
    parallel_for(grid.ny, [&](int j) {
      for (std::size_t at = (j + 1) * width + 1; at <= (j + 1) * width + grid.nx; ++at) {
        if (slices[1][at] <= coverage_rounding) continue;
        ++rows[j][0];
        if (is_grey(slices[1][at]) && is_grey_around(slices, at, width)) ++rows[j][1];
      }
    });
    for (const auto& [all, of_these] : rows) {
      covered += all;
      grey += of_these;
    }
  }
  return covered > 0 ? static_cast<double>(grey) / static_cast<double>(covered) : 0.0;
}

}  // namespace vam::model
