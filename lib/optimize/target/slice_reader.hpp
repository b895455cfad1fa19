// SPDX-License-Identifier: GPL-3.0-or-later
// The slices of a volume as the optimiser reads them, and the checks at its door.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "light/operators/operator.hpp"
#include "model/circle.hpp"
#include "optimize/target/schedule.hpp"
#include "optimize/target/surface_band.hpp"

namespace vam::optimize {

/// Functions that read `count` row-major slices from k on.
struct VolumeSource {
  using Read = std::function<void(int k, int count, float* out)>;
  int slices = 0;
  Read target;         // coverage, or response when grey
  Read insert;         // coverage of an opaque insert; may be empty
  Read weight;         // relative cost of a voxel's error, >= 0; may be empty
  Read tolerance;      // maximum deviation of a voxel's response, >= 0; may be empty
  Read delivered;      // dose that the voxels have received already, >= 0; may be empty
  double band_px = 0;  // half width of the unconstrained band around the surface
};

/// What one slice holds.
struct SliceData {
  std::vector<float> target, insert, weight, tolerance, delivered;  // all but the first empty where there is none
};

class SliceReader {
 public:
  SliceReader(const VolumeSource& source, light::Shape shape);
  [[nodiscard]] std::vector<SliceData> read(int k, int count) const;
  [[nodiscard]] SliceData read(int k) const { return read(k, 1).front(); }

 private:
  const VolumeSource& source_;
  std::size_t pixels_;
  std::optional<SurfaceBand> band_;
};

/// A reader of weights or tolerances that are made from the target: `values`, or `usual` everywhere where there are
/// none, changed wherever the target is 0. `pixels`: of a slice.
[[nodiscard]] VolumeSource::Read with_void(const VolumeSource::Read& target, const VolumeSource::Read& values,
                                           float usual, std::size_t pixels, const std::function<void(float&)>& change);

/// Digests of all slices, everything that they hold included. Throws Fault::data for a target that is empty, or full,
/// or reaches beyond the circle, one that shares voxels with the insert, and weights, tolerances or doses below 0;
/// `grey`: values are doses, so a full target is as good as any.
[[nodiscard]] std::vector<SliceDigest> check(const VolumeSource& source, light::Shape shape,
                                             const model::Circle& circle, bool grey);

}  // namespace vam::optimize
