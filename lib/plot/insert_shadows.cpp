// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/private/insert_sections.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

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

Image axial_shadow(const io::SparseVolume& insert, int k) {
  const model::Grid& grid = insert.grid();
  std::vector<float> values(grid.slice_size());
  insert.read_slices(k, 1, values.data());
  const InsertSlice slice{grid.nx, grid.ny, values.data()};
  Image shadow(grid.nx, grid.ny);
  if (std::none_of(values.begin(), values.end(), model::half_covered)) return shadow;
  parallel_for(grid.ny, [&](int row) {
    for (int x = 0; x < grid.nx; ++x) shadow(x, row) = hidden_share(slice, x, grid.ny - 1 - row);
  });
  return shadow;
}

Image upright_shadow(const io::SparseVolume& insert, Plane plane, int index) {
  const model::Grid& grid = insert.grid();
  const bool coronal = plane == Plane::coronal;
  Image shadow(coronal ? grid.nx : grid.ny, grid.nz);
  parallel_for(grid.nz, [&](int row) {
    std::vector<float> values(grid.slice_size());
    insert.read_slices(grid.nz - 1 - row, 1, values.data());
    if (std::none_of(values.begin(), values.end(), model::half_covered)) return;
    const InsertSlice slice{grid.nx, grid.ny, values.data()};
    for (int at = 0; at < shadow.width; ++at) {
      shadow(at, row) = coronal ? hidden_share(slice, at, index) : hidden_share(slice, index, at);
    }
  });
  return shadow;
}

}  // namespace

std::vector<InsertSection> insert_sections(const io::SparseVolume& insert, Plane plane,
                                           const std::vector<int>& indices) {
  std::vector<Image> coverage = planes(insert, plane, indices);
  std::vector<InsertSection> sections;
  for (std::size_t n = 0; n < indices.size(); ++n) {
    sections.push_back({std::move(coverage[n]), plane == Plane::axial ? axial_shadow(insert, indices[n])
                                                                      : upright_shadow(insert, plane, indices[n])});
  }
  return sections;
}

}  // namespace vam::plot
