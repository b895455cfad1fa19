// What forward and adjoint share: the angles, the trapezoids, and how slabs are grouped. Not for other modules.
#pragma once

#include <span>
#include <vector>

#include "base/simd.hpp"
#include "tomo/radon.hpp"
#include "tomo/radon_kernel.hpp"

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

/// Checks shapes; throws Error{Fault::bug} when slabs do not fit the geometry, Fault::data when e^{alpha u} overflows.
/// A full turn of an even number of angles without attenuation is folded: P(t, theta + pi) = P(-t, theta).
Plan make_plan(const ParallelGeometry& geometry, std::span<const Slab> images, std::span<const Slab> sinograms);

/// The trapezoid box(wide) * box(narrow) of area `total`, in entries r and r + 8 of the table.
void set_footprint(Footprints& footprints, int r, double wide, double narrow, double total, double step);

/// Puts the centre of output 0 in row r, in elements from the row's start, and, from the step, that of output 1.
inline void set_first(Gather& job, int r, double centre) {
  const double start = centre + 0.5 - static_cast<double>(job.footprints->half[r]);
  job.first[r] = static_cast<float>(start);
  job.first[gather_rows + r] = static_cast<float>(start + static_cast<double>(job.footprints->step[r]));
}

/// Slabs are taken 4, 2 or 1 at a time.
struct Group {
  int first;
  int slabs;
  [[nodiscard]] int log2() const { return slabs / 2; }
  [[nodiscard]] int pitch() const { return slabs * lanes; }
};
std::vector<Group> make_groups(std::size_t slabs);

const RadonKernels& radon_kernels(Simd level);

/// Scratch of this thread, zeroed or not as it was left; grows only.
Buffer& scratch(int which, std::size_t size);

}  // namespace vam::tomo
