// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/private/radon_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::tomo {

namespace {

constexpr double largest_exponent = 80;  // e^88 is the largest float

void check_shapes(std::span<const Slab> slabs, int width, int height, const char* what) {
  for (const Slab& slab : slabs) {
    if (slab.width == width && slab.height == height) continue;
    throw Error{Fault::bug, std::string(what) + ": slab of " + std::to_string(slab.width) + " x " +
                                std::to_string(slab.height) + ", but the geometry has " + std::to_string(width) +
                                " x " + std::to_string(height)};
  }
}

bool is_even_full_turn(const ParallelGeometry& geometry) {
  const double turn = std::abs(geometry.angles * geometry.angle_step_rad);
  return geometry.angles % 2 == 0 && std::abs(turn - 2 * std::numbers::pi) < 1e-9;
}

}  // namespace

void check_shapes(const ParallelGeometry& geometry, std::span<const Slab> images, std::span<const Slab> sinograms) {
  check_shapes(images, geometry.nx, geometry.ny, "image");
  check_shapes(sinograms, geometry.columns, geometry.angles, "sinogram");
  if (images.size() != sinograms.size()) throw Error{Fault::bug, "radon: numbers of images and sinograms differ"};
}

Plan make_plan(const ParallelGeometry& geometry, std::span<const Slab> images, std::span<const Slab> sinograms) {
  check_shapes(geometry, images, sinograms);
  const double reach = std::hypot(std::max(std::abs(geometry.axis_x), std::abs(geometry.nx - geometry.axis_x)),
                                  std::max(std::abs(geometry.axis_y), std::abs(geometry.ny - geometry.axis_y)));
  if (!(std::abs(geometry.alpha_per_px) * reach < largest_exponent)) {
    throw Error{Fault::data, "absorption of " + format_number(geometry.alpha_per_px) + " per pixel over " +
                                 format_number(reach) + " pixels overflows; it is given per mm, with voxels in mm"};
  }
  Plan plan;
  plan.folded = geometry.alpha_per_px == 0 && is_even_full_turn(geometry);
  const int count = plan.folded ? geometry.angles / 2 : geometry.angles;
  for (int a = 0; a < count; ++a) {
    const double theta = geometry.angle_start_rad + a * geometry.angle_step_rad;
    const double c = std::cos(theta);
    const double s = std::sin(theta);
    plan.rays.push_back({c, s, 0.5 * (geometry.columns - 1) - geometry.axis_x * c - geometry.axis_y * s});
  }
  return plan;
}

void set_footprint(Footprints& footprints, std::size_t r, double wide, double narrow, double total, double step) {
  const auto shadow = Trapezoid::of(static_cast<float>(wide), static_cast<float>(narrow), static_cast<float>(total));
  for (std::size_t e = r; e < pair_entries; e += gather_rows) {
    footprints.step[e] = static_cast<float>(step);
    footprints.half[e] = shadow.half;
    footprints.flat[e] = shadow.flat;
    footprints.curve[e] = shadow.curve;
    footprints.slope[e] = shadow.slope;
    footprints.half_total[e] = static_cast<float>(total / 2);
    footprints.first_edge[e] = 1 - shadow.half;
  }
}

std::vector<SlabGroup> make_groups(std::size_t slabs) {
  std::vector<SlabGroup> groups;
  for (std::size_t first = 0; first < slabs;) {
    const std::size_t left = slabs - first;
    const std::size_t take = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    groups.push_back({first, take});
    first += take;
  }
  return groups;
}

Ahead::Ahead(const GatherRows& rows, int calls) : rows_(rows) {
  for (const Interleave& row : rows) share_ += static_cast<std::ptrdiff_t>(row.count) * row.slabs;
  share_ = share_ / calls + 1;
}

bool Ahead::next_stream() {
  const int slabs = rows_[0].slabs;
  do {
    if (++stream_ >= gather_rows * slabs) return false;
    row_ = &rows_[stream_ / slabs];
  } while (row_->count == 0);
  left_ = row_->count;
  from_ = row_->from[stream_ % slabs];
  plus_ = row_->plus[stream_ % slabs];
  return true;
}

void Ahead::fetch_share() {
  for (std::ptrdiff_t n = share_; n > 0; --n) {
    if (left_ == 0 && !next_stream()) return;
    __builtin_prefetch(from_, 0, 2);
    if (plus_ != nullptr) {
      __builtin_prefetch(plus_, 0, 2);
      plus_ += row_->plus_step;
    }
    from_ += row_->from_step;
    --left_;
  }
}

const RadonKernels& radon_kernels(Simd level) { return VAM_KERNEL(radon_kernels, level); }

float* scratch(std::size_t which, std::size_t size) {
  thread_local std::array<Buffer, 2> buffers;
  Buffer& buffer = buffers.at(which);
  if (buffer.size() < size) buffer.resize(size);
  return buffer.data();
}

}  // namespace vam::tomo
