// SPDX-License-Identifier: GPL-3.0-or-later
// What an alignment answers to small errors of the surface that it aligns.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "solid/mesh/surface_samples.hpp"

namespace vam::solid {

/// The least-squares pose of points whose distances along their normals are known, linearised [CM92; physics §13.3].
class PoseResponse {
 public:
  /// Of the points that the alignment uses.
  PoseResponse(std::span<const SurfaceSample> points, bool with_scale);
  ~PoseResponse();
  PoseResponse(PoseResponse&&) noexcept;

  /// Rotation vector about the points' middle, shift and growth that reduce these distances most, one a point.
  /// Directions in which the surface slides on itself get no motion.
  using Motion = std::array<double, 7>;
  [[nodiscard]] Motion of(std::span<const double> distances_mm) const;
  /// What the motion adds to the distance of a place.
  [[nodiscard]] double at(const Motion& motion, const SurfaceSample& place) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::solid
