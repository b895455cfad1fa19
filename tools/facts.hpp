// SPDX-License-Identifier: GPL-3.0-or-later
// Facts of volumes and stacks: what their metadata state [formats: Attributes of volumes and prints].
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "base/text.hpp"
#include "model/mesh.hpp"
#include "model/part_surface.hpp"
#include "model/stretch.hpp"

namespace vam::tool {

using Facts = std::map<std::string, std::string>;

/// Empty if it is not stated, or not a number.
inline std::optional<double> stated_number(const Facts& facts, const std::string& name) {
  const auto found = facts.find(name);
  return found == facts.end() ? std::nullopt : parse_number(found->second);
}

/// The factor by which vam-slice stretched the part along z; 1 if it is not stated. Who read the file has judged it.
inline double stretch_z(const Facts& facts) {
  const auto found = facts.find(model::stretch_name);
  return found == facts.end() ? 1.0 : model::parse_stretch(found->second).value();
}

/// Throws Fault::data for a volume 'scatter' in units of mJ/cm3, which is a dose of that name; other units pass.
inline void require_scatter(const std::string& path, const std::string& units) {
  if (units != "mJ/cm3") return;
  throw Error{Fault::data, path + ": its values are a dose in mJ/cm3, not scattering; give a volume of vam-ost"};
}

/// Heights of the part instead of those of the stretched volume.
inline void unstretch(model::TriangleSoup& mesh, const Facts& facts) {
  const double factor = stretch_z(facts);
  for (auto& point : mesh.points) point[2] /= factor;
}

/// States what the part's own surface shows.
inline void state_surface(Facts& facts, const model::PartSurface& surface) {
  const auto text = [](const model::ThinPlaces& places) {
    std::string numbers = format_number(places.area_mm2, 4) + " " + format_number(places.mm, 4);
    for (const double mm : places.at_mm) numbers += " " + format_number(mm, 4);
    return numbers;
  };
  facts["vam:thin_walls"] = text(surface.walls);
  facts["vam:thin_gaps"] = text(surface.gaps);
  facts["vam:blocked_gaps"] = text(surface.blocked);
  facts["vam:thin_relief"] = text(surface.relief);
  if (surface.solids > 0) facts["vam:solids"] = std::to_string(surface.solids);
  if (surface.solids > 0 && surface.specks > 0) facts["vam:specks"] = std::to_string(surface.specks);
}

/// None where it is not stated, or not by five numbers each.
inline std::optional<model::PartSurface> stated_surface(const Facts& facts) {
  const auto places = [&](const char* name) -> std::optional<model::ThinPlaces> {
    const auto found = facts.find(name);
    if (found == facts.end()) return std::nullopt;
    std::istringstream text(found->second);
    std::vector<double> numbers;
    for (std::string word; text >> word;) numbers.push_back(parse_number(word).value_or(-1));
    constexpr std::size_t wanted = 5;
    if (numbers.size() != wanted || !(numbers[0] >= 0) || !(numbers[1] >= 0)) return std::nullopt;
    return model::ThinPlaces{numbers[0], numbers[1], {numbers[2], numbers[3], numbers[4]}};
  };
  const auto walls = places("vam:thin_walls");
  const auto gaps = places("vam:thin_gaps");
  const auto blocked = places("vam:blocked_gaps");
  const auto relief = places("vam:thin_relief");
  if (!walls || !gaps || !blocked || !relief) return std::nullopt;
  const auto count = [&](const char* name) {
    constexpr double most = 1e6;
    const double number = stated_number(facts, name).value_or(0);
    return number >= 0 && number <= most ? static_cast<int>(number) : 0;
  };
  const int solids = count("vam:solids");
  return model::PartSurface{*walls, *gaps, *blocked, *relief, solids, std::min(count("vam:specks"), solids)};
}

/// The dose at which the projections print, in the unit of the dose.
inline std::optional<double> threshold_dose(const Facts& facts) { return stated_number(facts, "vam:threshold_dose"); }

/// Throws Fault::data where it is stated, but not above 0 and at most a million.
inline std::optional<double> stated_positive(const Facts& facts, const std::string& name) {
  const auto found = facts.find(name);
  if (found == facts.end()) return std::nullopt;
  const auto value = parse_number(found->second);
  constexpr double most = 1e6;
  if (value && *value > 0 && *value <= most) return value;
  throw Error{Fault::data, "the projections state " + name + " " + excerpt(found->second) +
                               ", which is not above 0 and at most 1e6; compute them again"};
}

/// What a relative dose of 1 is, in mJ/cm3.
inline std::optional<double> dose_unit_mj_cm3(const Facts& facts) {
  return stated_number(facts, "vam:dose_unit_mj_cm3");
}

/// The value of a sinogram that is shown at full intensity.
inline std::optional<double> full_scale(const Facts& facts) { return stated_positive(facts, "vam:full_scale"); }

/// For how many turns it is shown.
inline std::optional<double> shown_turns(const Facts& facts) { return stated_positive(facts, "vam:shown_turns"); }

}  // namespace vam::tool
