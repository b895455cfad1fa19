// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/private/insert_shadows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "model/dose/dose_metrics.hpp"

namespace vam::plot {

namespace {

constexpr int directions = 48;

/// One slice of the insert, x fastest.
struct InsertSlice {
  int width;
  int height;
  const float* values;
  [[nodiscard]] bool hides(int x, int y) const { return model::half_covered(values[flat_index(y, width, x)]); }
};

bool is_hidden(const InsertSlice& slice, int x, int y, double angle) {
  const double dx = std::cos(angle);
  const double dy = std::sin(angle);
  for (int step = 1;; ++step) {
    const auto i = round_int(x + step * dx);
    const auto j = round_int(y + step * dy);
    if (i < 0 || j < 0 || i >= slice.width || j >= slice.height) return false;
    if (slice.hides(i, j)) return true;
  }
}

float hidden_share(const InsertSlice& slice, int x, int y) {
  if (slice.hides(x, y)) return 0;
  int hidden = 0;
  for (int d = 0; d < directions; ++d) {
    if (is_hidden(slice, x, y, 2 * std::numbers::pi * (d + 0.5) / directions)) ++hidden;
  }
  return static_cast<float>(hidden) / directions;
}

}  // namespace

std::vector<Image> insert_shadows(const io::SparseVolume& insert, Plane plane, const std::vector<int>& indices) {
  const model::Grid& grid = insert.grid();
  std::vector<Image> shadows;
  for (const int index : indices) {
    Image& shadow = shadows.emplace_back(plane_shape(grid, plane));
    const auto slice_of = [&](int row) { return plane == Plane::axial ? index : grid.nz - 1 - row; };
    parallel_for(shadow.height, [&](int y) {
      std::vector<float> values(grid.slice_size());
      insert.read_slices(slice_of(y), 1, values.data());
      if (std::none_of(values.begin(), values.end(), model::half_covered)) return;
      const InsertSlice slice{grid.nx, grid.ny, values.data()};
      for (int x = 0; x < shadow.width; ++x) {
        const auto [i, j] = plane_column(grid, plane, index, x, y);
        shadow(x, y) = hidden_share(slice, i, j);
      }
    });
  }
  return shadows;
}

}  // namespace vam::plot
