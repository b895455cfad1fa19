// SPDX-License-Identifier: GPL-3.0-or-later
// Dose of a continuous (or layer-by-layer) stereolithographic print along one pixel column [CURE19; physics §9].
// What the light of one slice adds while it is shown is the integral [CURE19 eq 2] of the rate [CURE19 eq 1], its sum
// over the slices [CURE19 eq 3], without dimensions [CURE19 eq 4], the recursion of dose_at_nodes() [CURE19 eq 5].
//
// Direction, fixed once: slice 0 is printed first and sticks to the platform; light enters through the window on the
// side of the highest slice, and depth zeta grows from the platform towards the window ([CURE19 fig 1d]: "z = 0 at the
// platform, increasing towards the window"). Slice n is the resin between the planes zeta = n and zeta = n + 1. It is
// exposed while the window moves from n to n + 1, so its light reaches the planes 0..n and none beyond.
//
// The nodes are where the dose is followed. Continuous: node = plane, 0..N; a feature of slices a..b-1 covers the nodes
// a..b and its designed edges are the two outer ones. Layer by layer: node n = the side of layer n that is turned away
// from the light, where the layer receives least; a feature of layers a..b-1 covers the nodes a..b-1.
#pragma once

#include <span>
#include <vector>

namespace vam::resin {

enum class ExposureMode { continuous, layered };

/// The best D_f / D_c [CURE19 fig 5].
inline constexpr double full_cure_factor = 5;

/// Resin, motion and light of a print. The defaults are the worked example of [CURE19 fig 2 and 4]; the paper gives no
/// intensities: these are what makes its figures (undercured from slice 38 of 41, 3 extra slices).
struct Process {
  ExposureMode exposure = ExposureMode::continuous;
  double slice_um = 50;                // h_s
  double absorbance_height_um = 2000;  // h_a: the depth in which the intensity falls to a tenth (base 10)
  double full_cure_dose_mj_cm3 = 576;  // D_f
  double speed_mm_h = 1000;            // s; layer by layer, a layer is exposed for h_s / s
  double min_intensity_mw_cm2 = 0.2;   // at grey 0: the contrast limit
  double max_intensity_mw_cm2 = 110;   // at full grey
};

/// What the mathematics needs of a process. Omega(node) = gain * Phi(node) + q * Omega(node + 1), Omega beyond the last
/// slice = 0 [CURE19 eq 5]: Omega = D / D_f, Phi = I / I_f, q = 10^(-h_s/h_a), gain = 1 - q (continuous) or q
/// (layered).
struct CureLimits {
  ExposureMode exposure = ExposureMode::continuous;
  double q = 0;
  double gain = 0;
  double phi_min = 0;
  double phi_max = 0;

  /// The dose that a constant Phi tends to.
  [[nodiscard]] double settled(double phi) const { return gain * phi / (1 - q); }
  /// The constant Phi that keeps a dose of 1: 1 when continuous [CURE19, "Phi_n = Omega_c"].
  [[nodiscard]] double hold() const { return (1 - q) / gain; }
  /// Omega(node) from the Phi of its slice and Omega(node + 1) [CURE19 eq 5].
  [[nodiscard]] double next(double phi, double omega) const { return gain * phi + q * omega; }
};

/// I_f. Continuous: s * D_f [CURE19 below eq 4]. Layered: the intensity whose exposure of h_s / s brings D_f to the
/// surface, D_f h_a s / (ln(10) h_s).
[[nodiscard]] double full_cure_intensity_mw_cm2(const Process& process);

/// Throws Fault::data: a value not finite or not positive, min >= max intensity, h_s > 10 h_a.
[[nodiscard]] CureLimits limits_of(const Process& process);

/// Omega at every node for one Phi per slice; result[n] for n in 0..phi.size(), the last one 0.
[[nodiscard]] std::vector<double> dose_at_nodes(std::span<const double> phi, const CureLimits& limits);

/// Omega half way through a slice, from its Phi and Omega at the node below it (exact for both exposures).
[[nodiscard]] double dose_at_centre(double phi, double next_node, const CureLimits& limits);

/// Fraction of the slice's thickness, in [0, 1], with Omega >= threshold. Exact: inside a slice the dose runs
/// monotonically between its two planes.
[[nodiscard]] double cured_fraction(double phi, double next_node, double threshold, const CureLimits& limits);

/// The fewest slices at phi_max that raise the dose from 0 to 1; 0 when no number does.
[[nodiscard]] int burst_slices(const CureLimits& limits);

/// Slices after the `slices` of a part that the burst below its deepest one, last_slice, needs; 0 for an empty part
/// (-1) or without a burst.
[[nodiscard]] int extra_slices(int last_slice, int slices, const CureLimits& limits);

/// Below this, differences of Omega are rounding: what counts as cured is Omega >= 1 - dose_tolerance.
inline constexpr double dose_tolerance = 1e-6;

}  // namespace vam::resin
