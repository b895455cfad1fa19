// SPDX-License-Identifier: GPL-3.0-or-later
// The coverage of voxels by a solid that is a function: boxes of voxels that the surface is clear of are filled whole,
// others halved, down to the smallest block.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "solid/shapes/field.hpp"
#include "solid/shapes/private/cell_fraction.hpp"
#include "solid/shapes/private/smooth_block.hpp"

namespace vam::solid {

namespace {

constexpr int block = 4;    // voxels along the edge of the smallest box
constexpr int widest = 16;  // and of the largest one

class Cover {
 public:
  Cover(const Field& field, const model::Grid& grid, int k0, int count, float* out)
      : field_(field), grid_(grid), k0_(k0), count_(count), out_(out) {}

  // Voxels [i, i + edge) x [j, j + edge) x [k, k + edge), as far as they are of the grid; k relative to k0.
  void box(int edge, int i, int j, int k) {
    const Point middle = middle_of(edge, i, j, k);
    box(edge, i, j, k, middle, field_.value(middle));
  }

 private:
  // With the field's value in the middle.
  void box(int edge, int i, int j, int k, const Point& middle, double value) {
    if (i >= grid_.nx || j >= grid_.ny || k >= count_) return;
    if (std::abs(value) > clear_mm(field_, half_diagonal * edge * grid_.voxel_mm)) {
      each(edge, i, j, k, [&](int, int, int) { return value < 0 ? 1.0 : 0.0; });
      return;
    }
    if (edge == 8 && is_smooth<8>(i, j, k, middle)) return;
    if (edge > block) {
      halves(edge / 2, i, j, k);
    } else if (!is_smooth<block>(i, j, k, middle)) {
      voxel_by_voxel(i, j, k);
    }
  }

  // The eight boxes of half the edge, whose values are found at once.
  void halves(int half, int i, int j, int k) {
    const auto place = [&](int part) {
      return std::array{i + (part & 1) * half, j + ((part >> 1) & 1) * half, k + (part >> 2) * half};
    };
    std::array<Point, 8> middles;
    std::array<double, 8> values{};
    for (int part = 0; part < 8; ++part) {
      const auto [x, y, z] = place(part);
      middles[part] = middle_of(half, x, y, z);
    }
    values_at(field_, middles, values.data());
    for (int part = 0; part < 8; ++part) {
      const auto [x, y, z] = place(part);
      box(half, x, y, z, middles[part], values[part]);
    }
  }

  [[nodiscard]] Point middle_of(int edge, int i, int j, int k) const {
    return voxel(i, j, k) + (0.5 * (edge - 1) * grid_.voxel_mm) * Point{1, 1, 1};
  }

  // Fills the box if it is.
  template <int edge>
  bool is_smooth(int i, int j, int k, const Point& middle) {
    const SmoothBlock<edge> smooth(field_, middle, grid_.voxel_mm);
    if (smooth.holds()) each(edge, i, j, k, [&](int x, int y, int z) { return smooth.fraction(x, y, z); });
    return smooth.holds();
  }

  void voxel_by_voxel(int i, int j, int k) {
    const double edge_mm = grid_.voxel_mm;
    const LatticeValues<block> middles(field_, voxel(i, j, k), 0, edge_mm);
    const LatticeValues<block + 1> corners(field_, voxel(i, j, k), -0.5, edge_mm);
    each(block, i, j, k, [&](int x, int y, int z) {
      return cell_fraction(field_, voxel(i + x, j + y, k + z), edge_mm, middles(x, y, z), corners.corners(x, y, z));
    });
  }

  // fraction(x, y, z) of the voxels of a box, counted from its first one.
  template <class Fraction>
  void each(int edge, int i, int j, int k, const Fraction& fraction) {
    const int right = std::min(edge, grid_.nx - i);
    for (int z = 0; z < std::min(edge, count_ - k); ++z) {
      for (int y = 0; y < std::min(edge, grid_.ny - j); ++y) {
        float* row = out_ + (static_cast<std::ptrdiff_t>(k + z) * grid_.ny + j + y) * grid_.nx + i;
        for (int x = 0; x < right; ++x) row[x] = static_cast<float>(fraction(x, y, z));
      }
    }
  }

  [[nodiscard]] Point voxel(int i, int j, int k) const { return {grid_.x_mm(i), grid_.y_mm(j), grid_.z_mm(k0_ + k)}; }

  const Field& field_;
  const model::Grid& grid_;
  int k0_;
  int count_;
  float* out_;
};

}  // namespace

void cover(const Field& field, const model::Grid& grid, int k0, int count, float* out) {
  const int boxes_y = (grid.ny + widest - 1) / widest;
  const int boxes_z = (count + widest - 1) / widest;
  parallel_for(boxes_y * boxes_z, [&](int item) {
    Cover voxels(field, grid, k0, count, out);
    for (int i = 0; i < grid.nx; i += widest) voxels.box(widest, i, item % boxes_y * widest, item / boxes_y * widest);
  });
}

}  // namespace vam::solid
