// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/shapes/shapes.hpp"

#include <optional>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "solid/shapes/private/builders.hpp"

namespace vam::solid {

namespace {

constexpr double least_mm = 1e-3;
constexpr double most_mm = 1000;

ShapeParameter mm(std::string_view name, double value, double low = least_mm) {
  return {name, value, "mm", low, most_mm};
}
ShapeParameter count(std::string_view name, double value, double low, double high) {
  return {name, value, "", low, high};
}

std::vector<ShapeKind> catalogue() {
  return {
      {"gyroid",
       "gyroid sheet in a cylinder [OST22 fig 6]",
       {mm("cell", 7), mm("sheet", 1), mm("diameter", 14), mm("height", 10)},
       build::gyroid},
      {"ball-in-cage",
       "loose ball in a cage of meridians and an equator [CAL17 fig 8A]",
       {mm("diameter", 12), mm("strut", 1.2), mm("ball", 6), count("meridians", 3, 1, 100)},
       build::ball_in_cage},
      {"octet",
       "octet truss [CAL17 fig 8C]",
       {mm("cell", 5), mm("strut", 0.8), count("across", 2, 1, 1000), count("layers", 2, 1, 1000)},
       build::octet},
      {"disc-grid",
       "discs on a square grid, constant cross-section [RAY21 fig 7]; 35 and 8 px of 0.065 mm",
       {mm("period", 2.275), mm("radius", 0.52), mm("diameter", 16), mm("height", 2)},
       build::disc_grid},
      {"hollow-cylinder",
       "tube [CAL17 fig 7]",
       {mm("outer", 10), mm("inner", 6, 0), mm("height", 10)},
       build::hollow_cylinder},
      {"half-cylinder",
       "half of a cylinder, cut along its axis [CAL17 fig 7]",
       {mm("diameter", 10), mm("height", 10)},
       build::half_cylinder},
      {"ladder",
       "two rails with rungs and gaps [CURE19 fig 2]",
       {mm("width", 8), mm("depth", 3), mm("rail", 1.5), mm("rung", 0.5), mm("gap", 0.5), count("rungs", 2, 1, 1000)},
       build::ladder},
      {"resolution",
       "bars and half rings of growing width on a base; 3 to 28 px of 0.065 mm",
       {mm("finest", 0.195), mm("coarsest", 1.82), count("steps", 8, 1, 100), mm("diameter", 15), mm("height", 2),
        mm("base", 0.5, 0)},
       build::resolution},
      {"boat",
       "boat with thin walls, cabin and funnel [OST22 fig 5]",
       {mm("length", 14), mm("wall", 0.7)},
       build::boat},
      {"egg-shell",
       "hollow egg with an opening at the top (opening=0: closed) [CURE19 fig 1]",
       {mm("length", 14), mm("diameter", 10), mm("wall", 0.8), mm("opening", 3, 0)},
       build::egg_shell},
      {"screwdriver",
       "shaft with a flat tip, to print around [CAL19 fig 4]",
       {mm("diameter", 4), mm("length", 24), mm("blade", 0.8)},
       build::screwdriver},
      {"handle",
       "fluted handle, bored for the shaft [CAL19 fig 4]",
       {mm("diameter", 12), mm("length", 16), mm("bore", 4), count("flutes", 8, 3, 100)},
       build::handle},
      {"sphere", "ball", {mm("diameter", 10)}, build::sphere},
      {"cylinder", "upright cylinder", {mm("diameter", 10), mm("height", 10)}, build::cylinder},
      {"box", "box, square by default [CAL17 fig 7]", {mm("x", 10), mm("y", 10), mm("z", 10)}, build::box},
      {"cone", "frustum, pointed by default", {mm("bottom", 10), mm("top", 0, 0), mm("height", 10)}, build::cone},
      {"torus", "ring [CAL19 fig 2I]", {mm("outer", 12), mm("tube", 3)}, build::torus},
  };
}

// The entry of that name; Fault::usage suggests the nearest one otherwise, or lists them all.
template <typename List>
const typename List::value_type& named(const List& list, std::string_view name, const std::string& what) {
  std::vector<std::string> names;
  for (const auto& item : list) {
    if (item.name == name) return item;
    names.emplace_back(item.name);
  }
  const std::string hint = did_you_mean(name, names);
  throw Error{Fault::usage, what + " '" + std::string{name} + "' is unknown" +
                                (hint.empty() ? "; known: " + join(names, ", ") : hint)};
}

double number(std::string_view text, const ShapeParameter& parameter, const std::string& subject) {
  const std::optional<double> parsed = parse_number(text);
  if (!parsed || !std::isfinite(*parsed))
    throw Error{Fault::usage, subject + " '" + std::string{text} + "' is not a number"};
  const double value = *parsed;
  if (value < parameter.low || value > parameter.high) {
    throw Error{Fault::usage, subject + " " + format_number(value) + " is outside " + format_number(parameter.low) +
                                  " ... " + format_number(parameter.high)};
  }
  if (parameter.unit.empty() && value != std::floor(value)) {
    throw Error{Fault::usage, subject + " " + format_number(value) + " is not a whole number"};
  }
  return value;
}

}  // namespace

const std::vector<ShapeKind>& shape_kinds() {
  static const std::vector<ShapeKind> kinds = catalogue();
  return kinds;
}

Field make_shape(const std::string& text) {
  const std::string_view all{text};
  const std::size_t colon = all.find(':');
  const ShapeKind& kind = named(shape_kinds(), all.substr(0, colon), "shape");
  const std::string subject = "shape " + std::string{kind.name};
  std::vector<double> values;
  for (const ShapeParameter& parameter : kind.parameters) values.push_back(parameter.value);
  if (colon + 1 == all.size()) throw Error{Fault::usage, subject + ": no parameter after the colon"};
  for (const std::string& item :
       colon == std::string_view::npos ? std::vector<std::string>{} : split(all.substr(colon + 1), ',')) {
    const std::size_t equals = item.find('=');
    if (equals == std::string_view::npos) {
      throw Error{Fault::usage, subject + ": '" + item + "' is not NAME=VALUE"};
    }
    const ShapeParameter& parameter =
        named(kind.parameters, std::string_view{item}.substr(0, equals), subject + ": parameter");
    values[&parameter - kind.parameters.data()] =
        number(std::string_view{item}.substr(equals + 1), parameter, subject + ": " + std::string{parameter.name});
  }
  return kind.build(values);
}

std::vector<std::string> describe_shapes() {
  std::vector<std::string> lines;
  for (const ShapeKind& kind : shape_kinds()) {
    std::string line = std::string{kind.name} + ": " + std::string{kind.help} + " (";
    for (const ShapeParameter& parameter : kind.parameters) {
      if (&parameter != &kind.parameters.front()) line += ",";
      line += std::string{parameter.name} + "=" + format_number(parameter.value);
    }
    lines.push_back(line + ")");
  }
  return lines;
}

}  // namespace vam::solid
