// SPDX-License-Identifier: GPL-3.0-or-later
// Target constraints of the voxels of a pass.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/compute/per_slice.hpp"
#include "model/circle.hpp"
#include "model/dose/dose_metrics.hpp"
#include "optimize/target/cure_curve.hpp"

namespace vam::optimize {

using model::Circle;
using model::Label;

/// The doses between which the print's threshold may lie: void below low, part above high. The printing threshold is
/// in the middle, the same number for every slice.
struct DoseWindow {
  double low = 0.75;
  double high = 0.85;
  [[nodiscard]] double threshold() const { return 0.5 * (low + high); }
};

/// Width of the logistic response, as a dose, unless a method has another.
inline constexpr double usual_softness = 0.05;

/// The demands on all slices.
struct Demands {
  DoseWindow window;
  bool free_surface = false;  // the dose at the part's surface need not be the threshold
  bool surface = false;       // voxels on the surface are constrained too: part from half coverage on, else void
  bool grey = false;          // the target is a response for every voxel, to be met within its tolerance
  bool void_below = false;    // grey: the void errs only by what it is beyond its tolerance
  // of the losses that look at the response
  CureCurve curve = CureCurve::logistic(DoseWindow{}.threshold(), usual_softness);
  double band = 0.1;  // epsilon: how far the response may be from the target, where no tolerance is given
};

/// Throws Fault::usage for contradictory thresholds.
void check(const Demands& demands);

/// Whether the dose is to be the threshold on the part's surface itself, and its voxels are free.
[[nodiscard]] constexpr bool asks_surface(const Demands& demands) {
  return !demands.grey && !demands.surface && !demands.free_surface;
}

/// Whether such a voxel is constrained.
[[nodiscard]] constexpr bool is_constrained(Label label) { return label == Label::part || label == Label::void_; }

struct Problem {
  int slices = 0;                          // lanes in use, from the first
  bool stacked = false;                    // they follow each other in the part, and share light
  std::vector<Slab> target;                // coverage 0...1 or response, zero outside the circle
  std::vector<std::vector<Label>> labels;  // per slab, indexed like Slab::values; grey: part where the target is not 0
  Demands demands;
  std::vector<Slab> weight;      // what an error of this voxel costs, the largest of a slice 1; empty: all 1
  std::vector<Slab> tolerance;   // epsilon of this voxel; empty: demands.band
  std::vector<Slab> delivered;   // dose that this voxel has received already; empty: none
  std::vector<float> gain = {};  // of each slice's target: not 1 of a thin slice [resolve_thin_slices]; empty: none is

  [[nodiscard]] float weight_at(std::size_t s, std::size_t i) const {
    return weight.empty() ? 1.0F : weight[s].values[i];
  }
  /// Whether the voxel's slice was scaled because no voxel of it is wholly inside the part.
  [[nodiscard]] bool is_thin(std::size_t s, std::size_t i) const {
    return !gain.empty() && gain[s * lanes + i % lanes] != 1.0F;
  }
  [[nodiscard]] float tolerance_at(std::size_t s, std::size_t i) const {
    return tolerance.empty() ? static_cast<float>(demands.band) : tolerance[s].values[i];
  }
};

/// Row-major slices, one after the other, in every array. Nullptr: none.
struct Slices {
  const float* target;
  const float* weight = nullptr;     // >= 0, relative to each other; a voxel of weight 0 is unconstrained
  const float* tolerance = nullptr;  // >= 0
  const float* delivered = nullptr;  // >= 0, in the unit of the dose
};

/// Adds up to 16 slices in a slab of their own. What lies outside the circle is left out. Slices that are not
/// stacked are resolved.
void append(Problem& problem, const Slices& slices, int count, int width, int height, const Circle& circle);

/// A slice without any voxel wholly inside the part is a thin wall's or is cut by a flat end of the part: if its
/// largest coverage is at least a half it is printed, scaled so that this is 1, with the voxels of at least half of it
/// for part; otherwise it stays dark. Where slices are stacked and the dose at the surface is prescribed, the slice
/// beside one with such voxels is left as it is: its surface says where the part ends.
void resolve_thin_slices(Problem& problem);

/// Adds what was delivered already to the dose of light.
void add_delivered(const Problem& problem, std::span<Slab> dose);

}  // namespace vam::optimize
