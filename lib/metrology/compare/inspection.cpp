// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/inspection.hpp"

#include "base/text/json.hpp"

namespace vam::metrology {

Inspection inspect(const model::TriangleSoup& print, const model::TriangleSoup& design_mesh,
                   const solid::Surface& design, int samples, const std::vector<Region>& regions) {
  Inspection made;
  made.distances = measure(print, design_mesh, design, samples);
  if (regions.empty()) return made;
  std::vector<Vector3> points;
  for (const auto& place : made.distances.on_print) points.push_back(place.point);
  made.feet = design.closest(points);
  const solid::Surface print_surface(print);
  for (const Region& region : regions) {
    made.regions.push_back(find_region(region, made.distances, made.feet, design, print_surface));
  }
  return made;
}

Json figures_json(const Inspection& inspection) {
  Json json = to_json(compare(inspection.distances));
  if (inspection.tolerance_mm) {
    json["within_percent"] = within_percent(inspection.distances.print_mm, *inspection.tolerance_mm);
  }
  json["alignment"]["shrinkage_percent"] = inspection.pose.shrinkage_percent;
  for (const RegionPoints& region : inspection.regions) {
    json["regions"][region.region.name] = region_json(region, inspection.distances, std::nullopt);
  }
  return json;
}

}  // namespace vam::metrology
