// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/one_slice_operator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/compute/per_slice.hpp"

namespace vam::light {

namespace {

// The slice as it is, turned by 90 degrees, mirrored, and both.
enum Copy { same, turned, mirrored, both };
constexpr int copies = 4;

/// Which pixel of the slice a pixel of its copy is, on a square of that side.
std::array<int, 2> pixel_of(int copy, int x, int y, int side) {
  const int last = side - 1;
  switch (copy) {
    case turned:
      return {last - y, x};
    case mirrored:
      return {last - x, y};
    case both:
      return {y, x};
    default:
      return {x, y};
  }
}

tomo::ParallelGeometry first_eighth(tomo::ParallelGeometry turn) {
  turn.angles = turn.angles / 8 + 1;
  return turn;
}

}  // namespace

bool OneSliceOperator::is_for(const tomo::ParallelGeometry& turn) {
  constexpr double exact = 1e-9;
  const double centre = 0.5 * (turn.nx - 1);
  return turn.alpha_per_px == 0 && turn.nx == turn.ny && turn.angles % 8 == 0 && turn.angle_start_rad == 0 &&
         std::abs(turn.angle_step_rad * turn.angles - 2 * std::numbers::pi) < exact &&
         std::abs(turn.axis_x - centre) < exact && std::abs(turn.axis_y - centre) < exact;
}

OneSliceOperator::OneSliceOperator(const tomo::ParallelGeometry& turn) : all_(turn), eighth_(first_eighth(turn)) {}

int OneSliceOperator::row_of(int copy, int row) const {
  const int half_turn = sinogram().height;
  switch (copy) {
    case turned:
      return half_turn / 2 + row;
    case mirrored:
      return half_turn - row;
    case both:
      return half_turn / 2 - row;
    default:
      return row;
  }
}

bool OneSliceOperator::is_repeated(int copy, int row) const {
  return (copy == mirrored || copy == both) && (row == 0 || row == eighth_.angles - 1);
}

void OneSliceOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  const int side = eighth_.nx;
  std::vector<Slab> slices = slabs(objects.size(), side, side);
  std::vector<Slab> rays = slabs(objects.size(), eighth_.columns, eighth_.angles);
  for (std::size_t s = 0; s < objects.size(); ++s) {
    parallel_for(side, [&](int y) {
      for (int x = 0; x < side; ++x) {
        for (int copy = 0; copy < copies; ++copy) {
          const auto [from_x, from_y] = pixel_of(copy, x, y, side);
          slices[s].at(x, y)[copy] = *objects[s].at(from_x, from_y);
        }
      }
    });
  }
  tomo::forward(eighth_, slices, rays);
  for (std::size_t s = 0; s < sinograms.size(); ++s) {
    std::fill(sinograms[s].values.begin(), sinograms[s].values.end(), 0.0F);
    parallel_for(eighth_.angles, [&](int row) {
      for (int copy = 0; copy < copies; ++copy) {
        if (is_repeated(copy, row)) continue;
        for (int c = 0; c < eighth_.columns; ++c) *sinograms[s].at(c, row_of(copy, row)) = rays[s].at(c, row)[copy];
      }
    });
  }
}

void OneSliceOperator::adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const {
  const int side = eighth_.nx;
  std::vector<Slab> rays = slabs(sinograms.size(), eighth_.columns, eighth_.angles);
  std::vector<Slab> slices = slabs(sinograms.size(), side, side);
  for (std::size_t s = 0; s < sinograms.size(); ++s) {
    parallel_for(eighth_.angles, [&](int row) {
      for (int copy = 0; copy < copies; ++copy) {
        if (is_repeated(copy, row)) continue;
        for (int c = 0; c < eighth_.columns; ++c) rays[s].at(c, row)[copy] = *sinograms[s].at(c, row_of(copy, row));
      }
    });
  }
  tomo::adjoint(eighth_, rays, slices);
  for (std::size_t s = 0; s < objects.size(); ++s) {
    std::fill(objects[s].values.begin(), objects[s].values.end(), 0.0F);
    for (int copy = 0; copy < copies; ++copy) {
      parallel_for(side, [&, copy](int y) {  // no two pixels of a copy are the same one of the slice
        for (int x = 0; x < side; ++x) {
          const auto [to_x, to_y] = pixel_of(copy, x, y, side);
          *objects[s].at(to_x, to_y) += slices[s].at(x, y)[copy];
        }
      });
    }
  }
}

}  // namespace vam::light
