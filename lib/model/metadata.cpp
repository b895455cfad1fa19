// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/metadata.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include "base/text/printable.hpp"
#include "base/text/text.hpp"

namespace vam::model {

namespace {

std::optional<double> parse_stretch(const std::string& text) {
  const auto factor = parse_number(text);
  return factor && *factor >= least_stretch && *factor <= most_stretch ? factor : std::nullopt;
}

std::string places_text(const ThinPlaces& places) {
  std::string numbers = format_number(places.area_mm2, 4) + " " + format_number(places.mm, 4);
  for (const double mm : places.at_mm) numbers += " " + format_number(mm, 4);
  return numbers;
}

/// Five numbers.
std::optional<ThinPlaces> stated_places(const Metadata& metadata, const std::string& name) {
  std::istringstream text(stated_text(metadata, name));
  std::vector<double> numbers;
  for (std::string word; text >> word;) numbers.push_back(parse_number(word).value_or(-1));
  constexpr std::size_t wanted = 5;
  if (numbers.size() != wanted || !(numbers[0] >= 0) || !(numbers[1] >= 0)) return std::nullopt;
  return ThinPlaces{numbers[0], numbers[1], {numbers[2], numbers[3], numbers[4]}};
}

int stated_count(const Metadata& metadata, const std::string& name) {
  constexpr double most = 1e6;
  const double number = stated_number(metadata, name).value_or(0);
  return number >= 0 && number <= most ? static_cast<int>(number) : 0;
}

}  // namespace

std::string stated_text(const Metadata& metadata, const std::string& name) {
  const auto found = metadata.find(name);
  return found == metadata.end() ? "" : found->second;
}

std::optional<double> stated_number(const Metadata& metadata, const std::string& name) {
  return parse_number(stated_text(metadata, name));
}

std::string stretch_objection(const std::string& text) {
  if (parse_stretch(text)) return "";
  return "states vam:stretch_z " + excerpt(text) + ", which is not a factor of 0.1 to 10; slice it again";
}

double stretch_z(const Metadata& metadata) {
  const auto found = metadata.find(stretch_name);
  return found == metadata.end() ? 1.0 : parse_stretch(found->second).value();
}

void unstretch(TriangleSoup& mesh, const Metadata& metadata) {
  const double factor = stretch_z(metadata);
  for (auto& point : mesh.points) point[2] /= factor;
}

void state_surface(Metadata& metadata, const PartSurface& surface) {
  metadata["vam:thin_walls"] = places_text(surface.walls);
  metadata["vam:thin_gaps"] = places_text(surface.gaps);
  metadata["vam:blocked_gaps"] = places_text(surface.blocked);
  metadata["vam:thin_relief"] = places_text(surface.relief);
  if (surface.solids > 0) metadata["vam:solids"] = std::to_string(surface.solids);
  if (surface.solids > 0 && surface.specks > 0) metadata["vam:specks"] = std::to_string(surface.specks);
}

std::optional<PartSurface> stated_surface(const Metadata& metadata) {
  const auto walls = stated_places(metadata, "vam:thin_walls");
  const auto gaps = stated_places(metadata, "vam:thin_gaps");
  const auto blocked = stated_places(metadata, "vam:blocked_gaps");
  const auto relief = stated_places(metadata, "vam:thin_relief");
  if (!walls || !gaps || !blocked || !relief) return std::nullopt;
  const int solids = stated_count(metadata, "vam:solids");
  return PartSurface{*walls, *gaps, *blocked, *relief, solids, std::min(stated_count(metadata, "vam:specks"), solids)};
}

std::optional<double> threshold_dose(const Metadata& metadata) { return stated_number(metadata, "vam:threshold_dose"); }

std::optional<double> dose_unit_mj_cm3(const Metadata& metadata) {
  return stated_number(metadata, "vam:dose_unit_mj_cm3");
}

}  // namespace vam::model
