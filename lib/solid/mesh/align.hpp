// SPDX-License-Identifier: GPL-3.0-or-later
// Brings a print onto its reference: no start needed, then point-to-plane ICP, optionally with a scale (shrinkage)
// [CM92; physics §13.3].
#pragma once

#include <array>
#include <optional>

#include "base/vector3.hpp"
#include "model/mesh.hpp"
#include "solid/mesh/signed_distance.hpp"

namespace vam::solid {

/// x -> scale * rotation * x + shift_mm. The rotation is proper (no mirror).
struct Similarity {
  double scale = 1;
  std::array<Vector3, 3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // rows
  Vector3 shift_mm{};

  [[nodiscard]] Vector3 operator()(const Vector3& x) const;
  /// Row-major 4 x 4 matrix for homogeneous columns.
  [[nodiscard]] std::array<std::array<double, 4>, 4> matrix() const;
};

struct AlignOptions {
  bool with_scale = false;
  int samples = 20000;  // points of the print in the final iterations
  int max_iterations = 100;
  double tolerance = 1e-6;  // stop when a step moves no point by more than this part of the size, or helps no more
};

/// Another pose of a part of a print that fits as well as the best.
struct AmbiguousPose {
  Similarity transform;
  double match = 0;       // share of the samples that lie on the reference, within 4 deviations of the best pose
  double best_match = 0;  // in the best pose
  double apart_mm = 0;    // mean distance of the samples in the two poses
};

struct Alignment {
  Similarity transform;
  double rms_mm = 0;   // distance of the samples to the reference after alignment
  int iterations = 0;  // of the final ICP
  bool converged = false;
  double overlap = 1;                  // share of the reference's surface that has the print within 4 % of the size
  bool as_part = false;                // so little that the print was taken for a part
  std::optional<AmbiguousPose> rival;  // of a part of a print, where there is one
};

/// Only ICP, from where the print is.
[[nodiscard]] Alignment refine(const model::TriangleSoup& print, const Surface& reference, const AlignOptions& options);

/// Centroids and principal axes of both surfaces give the starts: all 24 proper ways to lay the axes onto each other,
/// and turns about the axes that symmetry leaves undetermined; a short ICP ranks them, the best go on to the end.
/// Where these leave more than a seventh of the reference uncovered, the print is taken for a part: poses all over the
/// reference are tried, and turns of the best one, far points do not pull [BT74], and the best pose has a rival if
/// another one, which no symmetry of the reference explains, matches nine tenths as many points.
[[nodiscard]] Alignment align(const model::TriangleSoup& print, const model::TriangleSoup& reference_mesh,
                              const Surface& reference, const AlignOptions& options);

}  // namespace vam::solid
