// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/tolerances.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/random.hpp"
#include "base/text/text.hpp"

namespace vam::model {

namespace {

constexpr std::string_view example = "; write for example 'axis=0.5px,index=0.005,lamp=3%'";

std::string names() {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < robust_kinds; ++i) all.emplace_back(tolerance_table[i].name);
  return join(all, ", ");
}

/// Its place in the table.
std::size_t named(std::string_view name, const std::string& clause) {
  const auto is = [&](const Tolerance& one) { return one.name == name; };
  const auto end = tolerance_table.begin() + robust_kinds;
  const auto found = std::find_if(tolerance_table.begin(), end, is);
  if (found != end) return static_cast<std::size_t>(found - tolerance_table.begin());
  throw Error{Fault::usage,
              "'" + clause + "': no tolerance is called '" + std::string(name) + "'; there are " + names()};
}

double amount(std::string text, std::string_view unit, const std::string& clause) {
  if (!text.ends_with(unit)) {
    throw Error{Fault::usage, "'" + clause + "': the unit must be " + std::string(unit) + std::string(example)};
  }
  text = trimmed(std::string_view(text).substr(0, text.size() - unit.size()));
  const auto value = parse_number(text);
  if (value && std::isfinite(*value) && *value > 0) return *value;
  throw Error{Fault::usage, "'" + clause + "': '" + text + "' is not a number above 0" +
                                (unit.empty() ? "" : " in " + std::string(unit)) + std::string(example)};
}

double of(const Tolerances& tolerances, const PrinterDeviation& by, ToleranceKind what) {
  const auto i = static_cast<std::size_t>(what);
  return tolerances[i] * by[i];
}

}  // namespace

Tolerances parse_tolerances(const std::string& text) {
  Tolerances tolerances{};
  if (trimmed(text).empty()) throw Error{Fault::usage, "no tolerance is given" + std::string(example)};
  for (const std::string& part : split(text, ',')) {
    const std::string clause = trimmed(part);
    const auto at = clause.find('=');
    if (at == std::string::npos) throw Error{Fault::usage, "'" + clause + "' has no '='" + std::string(example)};
    const std::size_t i = named(trimmed(clause.substr(0, at)), clause);
    if (tolerances[i] > 0) throw Error{Fault::usage, "'" + clause + "': is given twice"};
    tolerances[i] = amount(trimmed(clause.substr(at + 1)), tolerance_table[i].unit, clause);
  }
  return tolerances;
}

std::string tolerances_text(const Tolerances& tolerances) {
  std::vector<std::string> clauses;
  for (std::size_t i = 0; i < tolerances.size(); ++i) {
    const Tolerance& one = tolerance_table[i];
    if (tolerances[i] == 0) continue;
    clauses.push_back(std::string(one.name) + "=" + format_number(tolerances[i]) + std::string(one.unit));
  }
  return join(clauses, ",");
}

std::vector<std::string> exact_quantities(const Tolerances& tolerances) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < robust_kinds; ++i) {
    if (tolerances[i] == 0) names.emplace_back(tolerance_table[i].name);
  }
  return names;
}

DeviatingPrinter deviate(const Printer& printer, const Tolerances& tolerances, const PrinterDeviation& by) {
  DeviatingPrinter off{printer,
                       of(tolerances, by, ToleranceKind::angle) * rad_per_deg,
                       1 + 0.01 * of(tolerances, by, ToleranceKind::lamp),
                       of(tolerances, by, ToleranceKind::sink),
                       of(tolerances, by, ToleranceKind::vial_x),
                       of(tolerances, by, ToleranceKind::vial_y),
                       0.01 * of(tolerances, by, ToleranceKind::rim)};
  off.printer.projector.axis_column += of(tolerances, by, ToleranceKind::axis);
  off.printer.resin.index += of(tolerances, by, ToleranceKind::index);
  off.printer.vial.radius_mm *= 1 + 0.01 * of(tolerances, by, ToleranceKind::radius);
  off.printer.resin.psf_mm = std::max(0.0, printer.resin.psf_mm + of(tolerances, by, ToleranceKind::psf));
  if (const double wider_deg = of(tolerances, by, ToleranceKind::aperture); wider_deg != 0)
    off.printer.projector.half_angle_deg = printer.projector.half_angle_deg.value_or(0) + wider_deg;
  if (off.intensity > 0 && off.printer.resin.index >= 1 && resin_radius_mm(off.printer.vial) > 0) return off;
  throw Error{Fault::usage, "tolerances: they allow an impossible printer (relative intensity " +
                                format_number(off.intensity) + ", resin index " +
                                format_number(off.printer.resin.index) + ", resin radius " +
                                format_number(resin_radius_mm(off.printer.vial)) + " mm); reduce them"};
}

std::vector<PrinterDeviation> balanced_corners() {
  std::vector<PrinterDeviation> corners(16);
  for (unsigned n = 0; n < corners.size(); ++n) {
    for (unsigned column = 0; column < corners[n].size(); ++column) {
      const bool is_odd = std::popcount(n / 2 & (column + 1)) % 2 != 0;  // Sylvester
      corners[n][column] = is_odd == (n % 2 != 0) ? 1 : -1;
    }
  }
  return corners;
}

PrinterDeviation drawn_deviation(std::uint64_t seed, int n) {
  PrinterDeviation by{};
  std::uint64_t state = scrambled(seed + static_cast<std::uint64_t>(n));
  for (double& one : by) one = 2 * unit_interval(state = scrambled(state)) - 1;
  return by;
}

}  // namespace vam::model
