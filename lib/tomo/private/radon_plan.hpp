// SPDX-License-Identifier: GPL-3.0-or-later
// What forward and adjoint share: angles, trapezoids, groups of slabs, rows on their way to the kernel. Not for other
// modules.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/compute/simd.hpp"
#include "tomo/private/radon_kernel.hpp"
#include "tomo/radon.hpp"

namespace vam::tomo {

using Buffer = std::vector<float, CacheAligned<float>>;

/// Pixel (x, y) has t = x * cosine + y * sine + offset in detector columns.
struct Ray {
  double cosine;
  double sine;
  double offset;
};

struct Plan {
  std::vector<Ray> rays;  // the angles to work out: all, or the first half turn
  bool folded;            // angle a + half holds the mirror image of angle a
};

/// Throws Error{Fault::bug} when slabs do not fit the geometry.
void check_shapes(const ParallelGeometry& geometry, std::span<const Slab> images, std::span<const Slab> sinograms);

/// Checks shapes; throws Fault::data when e^{alpha u} overflows.
/// A full turn of an even number of angles without attenuation is folded: P(t, theta + pi) = P(-t, theta).
Plan make_plan(const ParallelGeometry& geometry, std::span<const Slab> images, std::span<const Slab> sinograms);

/// The trapezoid box(wide) * box(narrow) of area `total`, in entries r and r + 8 of the table.
void set_footprint(Footprints& footprints, std::size_t r, double wide, double narrow, double total, double step);

/// Puts the centre of output 0 in row r, in elements from the row's start, and, from the step, that of output 1.
inline void set_first(Gather& job, std::size_t r, double centre) {
  const double start = centre + 0.5 - static_cast<double>(job.footprints->half[r]);
  job.first[r] = static_cast<float>(start);
  job.first[gather_rows + r] = static_cast<float>(start + static_cast<double>(job.footprints->step[r]));
}

/// Pixels a call, for any number of slabs, so that a slice's bytes do not depend on its neighbours; eight rows of them
/// fit in L1.
inline constexpr int segment = 16;

/// Slabs are taken 4, 2 or 1 at a time.
struct SlabGroup {
  std::size_t first;
  std::size_t slabs;
  [[nodiscard]] std::size_t log2() const { return slabs / 2; }
  [[nodiscard]] std::ptrdiff_t pitch() const { return static_cast<std::ptrdiff_t>(slabs) * lanes; }
};
std::vector<SlabGroup> make_groups(std::size_t slabs);

/// Where the kernel's eight input rows come from.
using GatherRows = std::array<Interleave, gather_rows>;

/// Brings the next rows into L2 while others are worked on: some cache lines after each of `calls` calls.
class Ahead {
 public:
  Ahead(const GatherRows& rows, int calls);
  void fetch_share();

 private:
  bool next_stream();
  const GatherRows& rows_;
  std::ptrdiff_t share_ = 1;
  int stream_ = -1;  // row * slabs + slab
  std::ptrdiff_t left_ = 0;
  const float* from_ = nullptr;
  const float* plus_ = nullptr;
  const Interleave* row_ = nullptr;
};

const RadonKernels& radon_kernels(Simd level);

/// Scratch of this thread, as it was left; grows only. `which` is 0 or 1.
float* scratch(std::size_t which, std::size_t size);

}  // namespace vam::tomo
