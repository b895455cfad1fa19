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

/// What may be off: a name, the unit in which its tolerance is written, and what it is.
struct Tolerance {
  std::string_view name;
  std::string_view unit;
  std::string_view meaning;
};
inline constexpr std::array<Tolerance, 6> tolerance_table{{{"axis", "px", "projector.axis_column"},
                                                           {"index", "", "resin.index"},
                                                           {"angle", "deg", "of the part relative to the frames"},
                                                           {"radius", "%", "vial.radius_mm"},
                                                           {"lamp", "%", "intensity"},
                                                           {"psf", "mm", "resin.psf_mm, which stays at least 0"}}};
enum class ToleranceKind : std::uint8_t { axis, index, angle, radius, lamp, psf };

/// Largest deviation of each, either way, in the unit of the table; 0: exact.
using Tolerances = std::array<double, tolerance_table.size()>;
/// Of one printer: -1...1 of each tolerance.
using PrinterDeviation = std::array<double, tolerance_table.size()>;

/// "axis=0.5px,index=0.005,angle=0.25deg,radius=0.2%,lamp=3%,psf=0.05mm", any of them, with their units; blanks may
/// stand around the commas. Throws Fault::usage naming the clause that is wrong and what there is.
[[nodiscard]] Tolerances parse_tolerances(const std::string& text);

/// "axis=0.5px,lamp=3%": those that are not 0, as parse_tolerances() reads them.
[[nodiscard]] std::string tolerances_text(const Tolerances& tolerances);
/// The names of those that are 0.
[[nodiscard]] std::vector<std::string> exact_quantities(const Tolerances& tolerances);

/// A printer off its settings.
struct DeviatingPrinter {
  Printer printer;
  double angle_offset_rad = 0;  // of the part relative to the frames
  double intensity = 1;         // of the lamp, as a multiple of its setting
};
/// Throws Fault::usage where the deviation leaves no lamp, no vial or an index below 1.
[[nodiscard]] DeviatingPrinter deviate(const Printer& printer, const Tolerances& tolerances,
                                       const PrinterDeviation& by);

/// Eight corners of the box of tolerances in which every two quantities meet in all four ways when the opposite corners
/// are added: the rows of Hadamard's matrix of order 8.
[[nodiscard]] std::vector<PrinterDeviation> balanced_corners();

/// Printer n of a seeded sequence: each deviation even in -1...1, the same on every machine.
[[nodiscard]] PrinterDeviation drawn_deviation(std::uint64_t seed, int n);

}  // namespace vam::model
