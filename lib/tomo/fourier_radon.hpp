// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel-beam projection A and its exact adjoint A* by the Fourier slice theorem [CAL17 eq 2]: the image's transform,
// interpolated along lines through its centre, is the transform of its projections [MFK04].
#pragma once

#include <memory>
#include <span>

#include "base/compute/simd.hpp"
#include "base/compute/slab.hpp"
#include "tomo/radon.hpp"

namespace vam::tomo {

/// What forward() and adjoint() of radon.hpp compute, in their units and conventions, to about 1e-3 of the largest
/// value: pixels are squares and bins as wide as a pixel, but what the footprints hold above 1 cycle per pixel is
/// left out [physics §1]. The time grows with the number of pixels, not with that times the angles. The same bytes for
/// any number of threads.
class FourierRadon {
 public:
  enum class Slices { one, all };

  /// `slices`: all 16 of each slab, or only its lane 0, in a fraction of the time and memory; others are set to 0.
  /// Throws Fault::bug for a geometry with alpha_per_px.
  explicit FourierRadon(const ParallelGeometry& geometry, Slices slices = Slices::all, Simd level = simd_level());
  ~FourierRadon();
  FourierRadon(const FourierRadon&) = delete;
  FourierRadon& operator=(const FourierRadon&) = delete;

  /// As the free functions; slabs are worked out one after the other on all threads, calls wait for each other.
  void forward(std::span<const Slab> images, std::span<Slab> sinograms) const;
  void adjoint(std::span<const Slab> sinograms, std::span<Slab> images) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::tomo
