// SPDX-License-Identifier: GPL-3.0-or-later
// Parametric test parts, among them those of the papers: no mesh needed.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solid/shapes/field.hpp"

namespace vam::solid {

struct ShapeParameter {
  std::string_view name;
  double value;           // default
  std::string_view unit;  // "mm", or empty for a count
  double low;             // allowed range, ends included
  double high;
};

/// One row of the catalogue.
struct ShapeKind {
  std::string_view name;
  std::string_view help;  // one line, no full stop
  std::vector<ShapeParameter> parameters;
  /// Values in the order of `parameters`. Throws Fault::usage where they do not fit together.
  Field (*build)(std::span<const double> values);
};

/// All shapes, in the order of the manual. Solids stand centred at the origin, z up.
[[nodiscard]] const std::vector<ShapeKind>& shape_kinds();

/// "gyroid" or "gyroid:cell=7,sheet=1". Throws Fault::usage for an unknown name (with the nearest known one), a bad
/// number, a value out of range, or values that do not fit together.
[[nodiscard]] Field make_shape(const std::string& text);

/// The catalogue as lines of text: name, help, parameters with their defaults.
[[nodiscard]] std::vector<std::string> describe_shapes();

}  // namespace vam::solid
