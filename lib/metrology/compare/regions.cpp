// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/regions.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"

namespace vam::metrology {

namespace {

constexpr double sine = 0.174;  // of 10 degrees
constexpr double cosine = 0.985;

struct KindName {
  const char* name;
  RegionKind kind;
  std::vector<std::string> figures;
};

const std::vector<KindName>& kinds() {
  static const std::vector<KindName> all{
      {"surface", RegionKind::surface, {}},
      {"plane", RegionKind::plane, {"flatness", "tilt", "offset"}},
      {"cylinder", RegionKind::cylinder, {"diameter", "cylindricity", "tilt", "offset"}},
      {"wall", RegionKind::wall, {"thickness", "min_thickness"}}};
  return all;
}

constexpr double alike = 0.5;     // cosine of 60 degrees
constexpr double near_it = 5e-3;  // of the design's largest dimension: meshes of one face differ by their chords

bool belongs(const Region& region, double near_mm, const Vector3& point, const Vector3& normal) {
  if (!region.faces) return region.box.contains(point);
  const solid::ClosestPoint foot = region.faces->closest(point);
  return length(foot.point - point) <= near_mm && dot(foot.normal, normal) > alike;
}

double angle_deg(const Vector3& a, const Vector3& b) {
  return std::atan2(length(cross(a, b)), std::abs(dot(a, b))) * deg_per_rad;
}

// The largest ball inside the design that touches its surface at a place [MBC12]: where it touches the other side.
solid::SurfaceSample other_side(const solid::SurfaceSample& from, const solid::Surface& design, double largest_mm) {
  double radius_mm = largest_mm;
  solid::ClosestPoint foot;
  constexpr int rounds = 30;
  for (int round = 0; round < rounds; ++round) {
    const Vector3 centre = from.point - radius_mm * from.normal;
    foot = design.closest(centre);
    const Vector3 chord = foot.point - from.point;
    if (length(foot.point - centre) > radius_mm * (1 - 1e-6)) break;
    radius_mm = dot(chord, chord) / (-2 * dot(chord, from.normal));
  }
  return {foot.point, foot.normal, foot.triangle};
}

/// Points of the design in the region, and of the print nearest to them; sides of a print that is too large, which an
/// edge of the design is nearest to, face elsewhere.
void gather(const Distances& distances, std::span<const solid::ClosestPoint> feet, RegionPoints& points) {
  const double near_mm = near_it * distances.largest_dimension_mm;
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const bool faces = dot(distances.on_print[i].normal, feet[i].normal) > alike;
    if (faces && belongs(points.region, near_mm, feet[i].point, feet[i].normal)) points.print.push_back(i);
  }
  for (std::size_t i = 0; i < distances.on_design.size(); ++i) {
    const solid::SurfaceSample& at = distances.on_design[i];
    if (belongs(points.region, near_mm, at.point, at.normal)) points.design.push_back(i);
  }
}

/// Leaves only what faces as wanted.
template <class Wanted>
void keep_facing(const Distances& distances, std::span<const solid::ClosestPoint> feet, const Wanted& wanted,
                 RegionPoints& points) {
  std::erase_if(points.print, [&](std::size_t i) { return !wanted(feet[i].normal); });
  std::erase_if(points.design, [&](std::size_t i) { return !wanted(distances.on_design[i].normal); });
}

void require_enough(const RegionPoints& points) {
  constexpr std::size_t fewest = 100;
  const std::size_t least = std::min(points.print.size(), points.design.size());
  if (least >= fewest) return;
  const std::string& file = points.region.faces_file;
  const std::string remedy =
      file.empty() ? "enlarge its box, or --samples"
                   : "the faces of " + file + " must lie on the design and face the same way; else increase --samples";
  throw Error{Fault::data, "region '" + points.region.name + "': has " + std::to_string(least) +
                               " points of the surface; " + remedy};
}

void find_walls(const Distances& distances, const solid::Surface& design, const solid::Surface& print,
                RegionPoints& points) {
  constexpr std::size_t most = 8000;
  constexpr double opposite = -0.7;
  const std::size_t every = points.design.size() / most | 1U;  // odd: each quarter of the points has some
  std::vector<std::size_t> kept;
  for (std::size_t n = 0; n < points.design.size(); n += every) {
    const auto& from = distances.on_design[points.design[n]];
    const auto there = other_side(from, design, distances.largest_dimension_mm);
    if (dot(there.normal, from.normal) > opposite) continue;
    if (!belongs(points.region, near_it * distances.largest_dimension_mm, there.point, there.normal)) continue;
    kept.push_back(points.design[n]);
    points.opposite.push_back(there);
    points.opposite_mm.push_back(-print.signed_distance(there.point));
  }
  points.design = std::move(kept);
}

std::vector<Vector3> places(const RegionPoints& points, const Distances& distances,
                            const std::optional<RegionErrors>& errors) {
  std::vector<Vector3> out;
  for (std::size_t n = 0; n < points.print.size(); ++n) {
    const std::size_t i = points.print[n];
    const double by = errors ? errors->print_mm[i] : 0.0;
    out.push_back(distances.on_print[i].point + by * points.print_normals[n]);
  }
  return out;
}

Json plane_json(const RegionPoints& points, std::span<const Vector3> print) {
  const PlaneFit found = fit_plane(print, points.plane.normal);
  return {{"flatness_mm", found.peak_to_valley_mm},
          {"tilt_deg", angle_deg(found.normal, points.plane.normal)},
          {"offset_mm", dot(points.plane.normal, found.point - points.plane.point)}};
}

Json cylinder_json(const RegionPoints& points, std::span<const Vector3> print) {
  const CylinderFit found = fit_cylinder(print, points.cylinder.axis);
  const Vector3 arm = found.point - points.cylinder.point;
  return {{"diameter_mm", 2 * found.radius_mm},
          {"design_diameter_mm", 2 * points.cylinder.radius_mm},
          {"cylindricity_mm", found.peak_to_valley_mm},
          {"tilt_deg", angle_deg(found.axis, points.cylinder.axis)},
          {"offset_mm", length(arm - dot(arm, points.cylinder.axis) * points.cylinder.axis)}};
}

Json wall_json(const RegionPoints& points, const Distances& distances, const std::optional<RegionErrors>& errors) {
  double least = 1e300;
  double sum = 0;
  double designed = 0;
  for (std::size_t n = 0; n < points.design.size(); ++n) {
    const std::size_t i = points.design[n];
    const double nominal = length(points.opposite[n].point - distances.on_design[i].point);
    double is = nominal + static_cast<double>(distances.design_mm[i]) + points.opposite_mm[n];
    if (errors) is += errors->design_mm[i] + errors->opposite_mm[n];
    least = std::min(least, is);
    sum += is;
    designed += nominal;
  }
  const auto count = static_cast<double>(points.design.size());
  return {{"thickness_mm", sum / count}, {"min_thickness_mm", least}, {"design_thickness_mm", designed / count}};
}

}  // namespace

Region parse_region(const std::string& text) {
  const std::string example = "; write for example top=plane:-5,-5,4.9,5,5,5.1 or seat=cylinder:seat.stl";
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || text.find_first_of(".,<> ") < equals) {
    throw Error{Fault::usage, "--region " + text + ": must begin with a name and '='" + example};
  }
  Region region{text.substr(0, equals)};
  std::string corners = text.substr(equals + 1);
  if (const auto colon = corners.find(':'); colon != std::string::npos) {
    const std::string wanted = corners.substr(0, colon);
    const auto found =
        std::find_if(kinds().begin(), kinds().end(), [&](const KindName& kind) { return kind.name == wanted; });
    if (found == kinds().end()) {
      throw Error{Fault::usage, "--region " + text + ": '" + wanted + "' is not one of surface, plane, cylinder, wall"};
    }
    region.kind = found->kind;
    corners = corners.substr(colon + 1);
  }
  if (!parse_number(trimmed(corners.substr(0, corners.find(','))))) {
    region.faces_file = corners;
    return region;
  }
  std::vector<double> values;
  for (const std::string& part : split(corners, ',')) {
    const auto value = parse_number(trimmed(part));
    if (!value || !std::isfinite(*value)) {
      throw Error{Fault::usage, "--region " + text + ": '" + part + "' is not a number" + example};
    }
    values.push_back(*value);
  }
  constexpr std::size_t wanted = 6;
  if (values.size() != wanted) {
    throw Error{Fault::usage, "--region " + text + ": has " + std::to_string(values.size()) +
                                  " coordinates; two corners have 6" + example};
  }
  for (std::size_t a = 0; a < 3; ++a) {
    region.box.low[a] = std::min(values[a], values[a + 3]);
    region.box.high[a] = std::max(values[a], values[a + 3]);
  }
  return region;
}

std::vector<std::string> region_figures(RegionKind kind) {
  std::vector<std::string> names{"rms", "mean", "max", "within"};
  for (const KindName& one : kinds()) {
    if (one.kind == kind) names.insert(names.end(), one.figures.begin(), one.figures.end());
  }
  return names;
}

RegionPoints find_region(const Region& region, const Distances& distances, std::span<const solid::ClosestPoint> feet,
                         const solid::Surface& design, const solid::Surface& print) {
  RegionPoints points;
  points.region = region;
  gather(distances, feet, points);
  require_enough(points);
  std::vector<Vector3> normals;
  Vector3 mean{};
  for (const std::size_t i : points.design) {
    normals.push_back(distances.on_design[i].normal);
    mean = mean + normals.back();
  }
  const auto design_places = [&] {
    std::vector<Vector3> out;
    for (const std::size_t i : points.design) out.push_back(distances.on_design[i].point);
    return out;
  };
  if (region.kind == RegionKind::plane) {
    mean = (1 / std::max(length(mean), 1e-12)) * mean;
    keep_facing(
        distances, feet, [&](const Vector3& n) { return dot(n, mean) > cosine; }, points);
    require_enough(points);
    points.plane = fit_plane(design_places(), mean);
  }
  if (region.kind == RegionKind::cylinder) {
    const Vector3 axis = axis_of(normals);
    keep_facing(
        distances, feet, [&](const Vector3& n) { return std::abs(dot(n, axis)) < sine; }, points);
    require_enough(points);
    points.cylinder = fit_cylinder(design_places(), axis);
  }
  if (region.kind == RegionKind::wall) {
    find_walls(distances, design, print, points);
    require_enough(points);
  }
  for (const std::size_t i : points.print) points.print_normals.push_back(feet[i].normal);
  return points;
}

PlaneFit print_plane(const RegionPoints& points, const Distances& distances) {
  return fit_plane(places(points, distances, std::nullopt), points.plane.normal);
}

Json region_json(const RegionPoints& points, const Distances& distances, const std::optional<RegionErrors>& errors) {
  std::vector<float> values;
  for (const std::size_t i : points.print) {
    values.push_back(distances.print_mm[i] + static_cast<float>(errors ? errors->print_mm[i] : 0.0));
  }
  const SurfaceDeviation d = deviation(values);
  Json json{{"mean_mm", d.mean_mm}, {"rms_mm", d.rms_mm}, {"max_mm", d.max_abs_mm}};
  const std::optional<double>& tolerance_mm = points.region.tolerance_mm;
  if (tolerance_mm) json["within_percent"] = within_percent(values, *tolerance_mm);
  if (points.region.kind == RegionKind::plane) json.update(plane_json(points, places(points, distances, errors)));
  if (points.region.kind == RegionKind::cylinder) json.update(cylinder_json(points, places(points, distances, errors)));
  if (points.region.kind == RegionKind::wall) json.update(wall_json(points, distances, errors));
  return json;
}

}  // namespace vam::metrology
