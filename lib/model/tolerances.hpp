// SPDX-License-Identifier: GPL-3.0-or-later
// Tolerances of the printer's settings, and printers that deviate by them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "model/printer.hpp"

namespace vam::model {

/// What may be off: a name, the unit in which its tolerance is written, what it is, how far it is off where nothing is
/// known of it, and whether it can be so one way only.
struct Tolerance {
  std::string_view name;
  std::string_view unit;
  std::string_view meaning;
  double typical;
  bool one_way = false;
};
inline constexpr std::array<Tolerance, 11> tolerance_table{
    {{"axis", "px", "projector.axis_column", 0.5},
     {"index", "", "resin.index", 0.005},
     {"angle", "deg", "of the part relative to the frames", 0.25},
     {"radius", "%", "vial.radius_mm", 0.2},
     {"lamp", "%", "intensity", 3},
     {"psf", "mm", "resin.psf_mm, which stays at least 0", 0.05},
     {"sinking", "mm", "of the part, evenly while the frames are shown once", 0.1, true},
     {"vial-x", "mm", "eccentricity along the projector's columns at stage angle 0", 0.05},
     {"vial-y", "mm", "eccentricity along the light at stage angle 0", 0.05},
     {"rim", "%", "intensity lost in the image's corners", 10, true},
     {"aperture", "deg", "projector.half_angle_deg", 0.64, true}}};
enum class ToleranceKind : std::uint8_t { axis, index, angle, radius, lamp, psf, sink, vial_x, vial_y, rim, aperture };
inline constexpr std::size_t robust_kinds = 6;  // the first, which light can be made for (--robust)

/// Largest deviation of each, either way, in the unit of the table; 0: exact.
using Tolerances = std::array<double, tolerance_table.size()>;
/// Of one printer: -1...1 of each tolerance.
using PrinterDeviation = std::array<double, tolerance_table.size()>;

/// "axis=0.5px,index=0.005,angle=0.25deg,radius=0.2%,lamp=3%,psf=0.05mm", any of them, with their units; blanks may
/// stand around the commas; the first robust_kinds only. Throws Fault::usage naming the clause that is wrong and what
/// there is.
[[nodiscard]] Tolerances parse_tolerances(const std::string& text);

/// "axis=0.5px,lamp=3%": those that are not 0, as parse_tolerances() reads them.
[[nodiscard]] std::string tolerances_text(const Tolerances& tolerances);
/// The names of those of the first robust_kinds that are 0.
[[nodiscard]] std::vector<std::string> exact_quantities(const Tolerances& tolerances);

/// A printer off its settings.
struct DeviatingPrinter {
  Printer printer;
  double angle_offset_rad = 0;  // of the part relative to the frames
  double intensity = 1;         // of the lamp, as a multiple of its setting
  double sinking_mm = 0;
  double vial_x_mm = 0, vial_y_mm = 0;  // of the vial's axis from the rotation axis, at stage angle 0
  double rim = 0;                       // intensity that the image's corners lack, of its middle's
};
/// Throws Fault::usage where the deviation leaves no lamp, no vial or an index below 1.
[[nodiscard]] DeviatingPrinter deviate(const Printer& printer, const Tolerances& tolerances,
                                       const PrinterDeviation& by);

/// Corners of the box of tolerances, each followed by the opposite one, in which every two of the first robust_kinds
/// meet in all four ways: the rows of Hadamard's matrix of order 8.
[[nodiscard]] std::vector<PrinterDeviation> balanced_corners();

/// Printer n of a seeded sequence: each deviation even in -1...1, the same on every machine.
[[nodiscard]] PrinterDeviation drawn_deviation(std::uint64_t seed, int n);

/// How far a vial may stand beside its place: there the polynomials of its rays err by some 0.03 columns.
constexpr double most_displacement_mm(double resin_radius_mm) { return resin_radius_mm / 12; }

}  // namespace vam::model
