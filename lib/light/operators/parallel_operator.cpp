// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/parallel_operator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/compute/per_slice.hpp"

namespace vam::light {

namespace {

/// On a square grid about the axis, a slice that is turned by 90 degrees, mirrored, or both has the projections of
/// other angles of the half turn: four lanes of copies take an eighth of a turn. Lane 0 of a slab is its slice, the
/// others are not read, and written as 0. Agrees with the ParallelOperator but for rounding.
class OneSliceOperator final : public Operator {
 public:
  [[nodiscard]] static bool is_for(const tomo::ParallelGeometry& turn);
  explicit OneSliceOperator(const tomo::ParallelGeometry& turn);

  [[nodiscard]] Shape object() const override { return all_.object(); }
  [[nodiscard]] Shape sinogram() const override { return all_.sinogram(); }
  [[nodiscard]] Shape image() const override { return all_.image(); }
  [[nodiscard]] double row_angle_rad() const override { return all_.row_angle_rad(); }
  void forward(std::span<const Slab> objects, std::span<Slab> sinograms) const override;
  void adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const override;
  void filter(std::span<Slab> sinograms) const override { all_.filter(sinograms); }
  void precondition(std::span<Slab> sinograms) const override { all_.precondition(sinograms); }
  void expand(const Slab& sinogram, Slab& image) const override { all_.expand(sinogram, image); }
  void collapse(const Slab& image, Slab& sinogram) const override { all_.collapse(image, sinogram); }

 private:
  /// The row of the half turn that a copy has at this row of the eighth.
  [[nodiscard]] int row_of(int copy, int row) const;
  /// At either end of the eighth two copies have the same rows.
  [[nodiscard]] bool is_repeated(int copy, int row) const;

  ParallelOperator all_;
  tomo::ParallelGeometry eighth_;
};

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

bool may_halve(const tomo::ParallelGeometry& turn) { return turn.angles % 2 == 0 && turn.alpha_per_px == 0; }

tomo::ParallelGeometry first_half(tomo::ParallelGeometry turn) {
  if (may_halve(turn)) turn.angles /= 2;
  return turn;
}

double row_angle(const tomo::ParallelGeometry& turn) {
  return std::abs(turn.angle_step_rad) * (may_halve(turn) ? 2 : 1);
}

}  // namespace

ParallelOperator::ParallelOperator(const tomo::ParallelGeometry& turn, LineIntegrals integrals)
    : turn_(turn),
      rows_(first_half(turn)),
      row_angle_rad_(row_angle(turn)),
      inverse_(turn.columns, turn.angle_step_rad, 0.5 * row_angle_rad_) {
  using Slices = tomo::FourierRadon::Slices;
  if (integrals == LineIntegrals::footprints) return;
  const Slices slices = integrals == LineIntegrals::fourier_of_one ? Slices::one : Slices::all;
  fourier_ = std::make_unique<tomo::FourierRadon>(rows_, slices);
}

void ParallelOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  fourier_ ? fourier_->forward(objects, sinograms) : tomo::forward(rows_, objects, sinograms);
}

void ParallelOperator::adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const {
  fourier_ ? fourier_->adjoint(sinograms, objects) : tomo::adjoint(rows_, sinograms, objects);
}

std::unique_ptr<Operator> ParallelOperator::for_one_slice() const {
  return OneSliceOperator::is_for(turn_) ? std::make_unique<OneSliceOperator>(turn_) : nullptr;
}

void ParallelOperator::expand(const Slab& sinogram, Slab& image) const {
  const auto fluence = static_cast<float>(1.0 / row_angle_rad_);
  parallel_for(turn_.angles, [&](int a) {
    const bool mirrored = a >= rows_.angles;
    for (int c = 0; c < turn_.columns; ++c) {
      const float* from = mirrored ? sinogram.at(turn_.columns - 1 - c, a - rows_.angles) : sinogram.at(c, a);
      std::transform(from, from + lanes, image.at(c, a), [&](float v) { return v * fluence; });
    }
  });
}

void ParallelOperator::collapse(const Slab& image, Slab& sinogram) const {
  const auto dose = static_cast<float>(halved() ? 0.5 * row_angle_rad_ : row_angle_rad_);
  parallel_for(rows_.angles, [&](int a) {
    for (int c = 0; c < turn_.columns; ++c) {
      const float* here = image.at(c, a);
      const float* there = halved() ? image.at(turn_.columns - 1 - c, a + rows_.angles) : nullptr;
      float* to = sinogram.at(c, a);
      for (int lane = 0; lane < lanes; ++lane) to[lane] = dose * (here[lane] + (there ? there[lane] : 0.0F));
    }
  });
}

}  // namespace vam::light
