// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/shapes/private/smooth_block.hpp"

#include <cmath>

namespace vam::solid {

namespace {

constexpr double corner_limit = 0.05;    // of the steepness: from total degree 2, at the block's corners
constexpr double between_limit = 0.005;  // from the interpolant, between its nodes

/// Weights of the nodes at -1, 0, 1 for the value at t.
std::array<double, 3> weights_at(double t) { return {0.5 * t * (t - 1), 1 - t * t, 0.5 * t * (t + 1)}; }

/// Values at places along each axis, from `first` in steps of `step`, from 3 x 3 x 3 nodes.
template <std::size_t count>
void spread(const LatticeValues<3>& nodes, double first, double step, LatticeValues<count>& to) {
  std::array<std::array<double, 3>, count> weights{};
  for (std::size_t i = 0; i < count; ++i) weights[i] = weights_at(first + step * static_cast<double>(i));
  std::array<double, 9 * count> along_x{};
  for (std::size_t row = 0; row < 9; ++row) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto& w = weights[i];
      const double* node = &nodes.values[3 * row];
      along_x[row * count + i] = w[0] * node[0] + w[1] * node[1] + w[2] * node[2];
    }
  }
  std::array<double, 3 * count * count> along_xy{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < count; ++j) {
      const auto& w = weights[j];
      const double* row = &along_x[k * 3 * count];
      for (std::size_t i = 0; i < count; ++i) {
        along_xy[(k * count + j) * count + i] = w[0] * row[i] + w[1] * row[count + i] + w[2] * row[2 * count + i];
      }
    }
  }
  constexpr std::size_t plane = count * count;
  for (std::size_t k = 0; k < count; ++k) {
    const auto& w = weights[k];
    for (std::size_t i = 0; i < plane; ++i) {
      to.values[k * plane + i] = w[0] * along_xy[i] + w[1] * along_xy[plane + i] + w[2] * along_xy[2 * plane + i];
    }
  }
}

}  // namespace

template <int side>
SmoothBlock<side>::SmoothBlock(const Field& field, const Point& middle, double voxel_mm)
    : clear_mm_(clear_mm(field, half_diagonal * voxel_mm)), nodes_(field, middle, -1, 0.5 * side * voxel_mm) {
  const double half_mm = 0.5 * side * voxel_mm;
  const Point slope{nodes_(2, 1, 1) - nodes_(0, 1, 1), nodes_(1, 2, 1) - nodes_(1, 0, 1),
                    nodes_(1, 1, 2) - nodes_(1, 1, 0)};
  steepness_ = length(slope) / side;
  if (!is_quadratic()) return;
  spread(nodes_, -1, 2.0 / side, corners_);
  spread(nodes_, 1.0 / side - 1, 2.0 / side, centres_);
  const LatticeValues<2> between(field, middle, -0.5, half_mm);
  for (unsigned c = 0; c < 8; ++c) {
    const auto place = [&](unsigned a) { return ((c >> a) & 1U) == 0 ? side / 4 : 3 * side / 4; };
    const double expected = corners_(place(0), place(1), place(2));
    if (std::abs(between.values[c] - expected) > between_limit * steepness_) return;
  }
  holds_ = true;
}

template <int side>
bool SmoothBlock<side>::is_quadratic() const {
  const auto node = [&](int i, int j, int k) { return nodes_(i + 1, j + 1, k + 1); };
  const double middle = node(0, 0, 0);
  const double even =
      0.5 * (node(1, 0, 0) + node(-1, 0, 0) + node(0, 1, 0) + node(0, -1, 0) + node(0, 0, 1) + node(0, 0, -1)) -
      3 * middle;  // of every corner
  const Point slope{0.5 * (node(1, 0, 0) - node(-1, 0, 0)), 0.5 * (node(0, 1, 0) - node(0, -1, 0)),
                    0.5 * (node(0, 0, 1) - node(0, 0, -1))};
  const double xy = 0.25 * (node(1, 1, 0) - node(1, -1, 0) - node(-1, 1, 0) + node(-1, -1, 0));
  const double yz = 0.25 * (node(0, 1, 1) - node(0, 1, -1) - node(0, -1, 1) + node(0, -1, -1));
  const double zx = 0.25 * (node(1, 0, 1) - node(-1, 0, 1) - node(1, 0, -1) + node(-1, 0, -1));
  for (const int k : {-1, 1}) {
    for (const int j : {-1, 1}) {
      for (const int i : {-1, 1}) {
        const double expected =
            middle + even + i * slope[0] + j * slope[1] + k * slope[2] + i * j * xy + j * k * yz + k * i * zx;
        if (!(std::abs(node(i, j, k) - expected) <= corner_limit * steepness_)) return false;
      }
    }
  }
  return true;
}

template <int side>
double SmoothBlock<side>::fraction(int i, int j, int k) const {
  const double middle = centres_(i, j, k);
  if (std::abs(middle) > clear_mm_) return middle < 0 ? 1 : 0;
  return Plane(corners_.corners(i, j, k)).fraction(middle);
}

template class SmoothBlock<4>;
template class SmoothBlock<8>;

}  // namespace vam::solid
