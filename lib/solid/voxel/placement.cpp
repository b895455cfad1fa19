// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/placement.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "model/rows.hpp"

namespace vam::solid {

namespace {

constexpr int most_voxels = 4096;     // a side of a slice; 64 MiB were it dense
constexpr int most_slices = 65536;    // as many images as a stack may have rows
constexpr double rounding_mm = 1e-6;  // a part made to measure may touch the border

// A voxel's centre may be that far beyond the surface that cuts the voxel, in voxels: half the diagonal in the plane.
constexpr double beyond_surface = 0.5 * std::numbers::sqrt2;

// There is a place for a part of some size.
void require_room(const Writable& room, double voxel_mm, const std::string& subject) {
  if (room.radius_mm > beyond_surface * voxel_mm) return;
  throw Error{Fault::data, subject + ": voxels of " + format_number(voxel_mm) +
                               " mm are as large as the writable radius of " + format_number(room.radius_mm, 4) +
                               " mm; use smaller voxels"};
}

using ExtentUnder = std::function<PlacedExtent(const Affine&)>;

Affine place(const ExtentUnder& under, const Placement& placement, const Writable& room, const std::string& subject) {
  Affine map =
      rotation(placement.rotate_deg) * (scaling({placement.scale, placement.scale, placement.scale}) * placement.axes);
  const PlacedExtent part = under(map);
  const double largest = part.box.largest_side();
  if (!(largest > 0)) throw Error{Fault::data, subject + ": has no size, all its points coincide; save the mesh again"};
  if (placement.centre) map.shift = map.shift - part.box.centre();
  double factor = 1;
  if (placement.fit_mm) factor = *placement.fit_mm / largest;
  if (placement.fit_writable) {
    require_room(room, placement.voxel_mm, subject);
    factor = fitting_factor(under(scaling({1, 1, placement.stretch_z}) * map), room, placement.voxel_mm);
  }
  map = scaling({factor, factor, factor}) * map;
  map.shift = map.shift + placement.at_mm;
  return scaling({1, 1, placement.stretch_z}) * map;
}

/// "give --scale 0.264 or --fit-writable": what makes the part fit.
std::string smaller(const PlacementAdvice& advice, double factor) {
  const std::string& size = advice.size;
  return "give " +
         (factor > 0 ? size + " " + format_number(three_digits(advice.value * factor), 3) : "a smaller " + size) +
         advice.or_fit;
}

/// `what` reaches that far from the axis.
void require_radius(double reach_mm, const Writable& room, double voxel_mm, const std::string& what,
                    const std::string& remedy, const std::string& beyond) {
  if (reach_mm <= room.radius_mm + rounding_mm) return;
  const auto both = [&](double mm) {
    return format_number(mm, 4) + " mm (" + format_number(mm / voxel_mm, 4) + " voxels)";
  };
  const std::string far = what + " " + both(reach_mm) + " from the axis, beyond the ";
  if (!room.from_all_sides) {
    throw Error{Fault::data, far + "resin's edge at " + both(room.radius_mm) + "; " + remedy + " to make it fit"};
  }
  throw Error{Fault::data,
              far + "writable radius of " + both(room.radius_mm) + "; " + remedy + " to make it fit" + beyond};
}

}  // namespace

Writable writable(const model::Printer& printer, double radius_mm) {
  const model::Projector& projector = printer.projector;
  return {radius_mm, model::z_mm(projector, projector.rows - 0.5), model::z_mm(projector, -0.5)};
}

Writable whole_resin(const model::Printer& printer) {
  Writable resin = writable(printer, model::resin_radius_mm(printer.vial));
  resin.from_all_sides = false;
  return resin;
}

double three_digits(double value) {
  constexpr double rounding = 1e-12;  // 0.415 may be a little less
  const double decimals = 2 - std::floor(std::log10(value));
  const double power = std::pow(10.0, std::abs(decimals));  // exact: a step of 0.001 is not
  return decimals > 0 ? std::floor(value * power * (1 + rounding)) / power
                      : std::floor(value / power * (1 + rounding)) * power;
}

Affine upright(const std::string& axis) {
  static const std::map<std::string, Point> turns{{"x", {0, -90, 0}}, {"y", {90, 0, 0}},   {"z", {0, 0, 0}},
                                                  {"-x", {0, 90, 0}}, {"-y", {-90, 0, 0}}, {"-z", {180, 0, 0}}};
  return rotation(turns.at(axis));
}

Affine mirrored(const std::string& axis) {
  Point sign{1, 1, 1};
  sign[axis.at(0) - 'x'] = -1;
  return scaling(sign);
}

double fitting_factor(const PlacedExtent& part, const Writable& room, double voxel_mm) {
  double factor = (room.radius_mm - beyond_surface * voxel_mm) / part.radius_mm;
  const double height = part.box.size()[2];
  const bool level = std::abs(room.low_mm + room.high_mm) < rounding_mm;  // else the part is lifted by whole voxels
  if (height > 0) factor = std::min(factor, (room.high_mm - room.low_mm - (level ? 0 : voxel_mm)) / height);
  return factor;
}

PlacedExtent extent(const model::TriangleSoup& soup, const Affine& map) {
  PlacedExtent result;
  for (const auto& triangle : soup.triangles) {
    for (const int index : triangle) {
      const Point p = map(soup.points[index]);
      result.box.add(p);
      result.radius_mm = std::max(result.radius_mm, std::hypot(p[0], p[1]));
    }
  }
  return result;
}

PlacedExtent extent(const Field& field) { return {field.box, field.radius_mm}; }

Affine place(const model::TriangleSoup& soup, const Placement& placement, const Writable& room,
             const std::string& subject) {
  return place([&](const Affine& map) { return extent(soup, map); }, placement, room, subject);
}

Affine place(const Field& field, const Placement& placement, const Writable& room, const std::string& subject) {
  return place([&](const Affine& map) { return extent(transformed(field, map)); }, placement, room, subject);
}

void transform(model::TriangleSoup& soup, const Affine& map) {
  for (auto& point : soup.points) point = map(point);
  const bool mirrors = dot(map.linear[0], cross(map.linear[1], map.linear[2])) < 0;
  if (mirrors) {
    for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
  }
}

model::TriangleSoup in_rows(const std::vector<model::TriangleSoup>& bodies, std::optional<std::array<int, 3>> counts,
                            double gap) {
  std::vector<Bounds> boxes;
  Point pitch{};
  for (const auto& body : bodies) {
    const Point size = boxes.emplace_back(extent(body).box).size();
    for (std::size_t d = 0; d < 3; ++d) pitch[d] = std::max(pitch[d], size[d] + gap);
  }
  const int count = count_of(bodies);
  const auto radius = [&](int along_x) {
    return std::hypot(along_x * pitch[0] - gap, (count + along_x - 1) / along_x * pitch[1] - gap);
  };
  int best = 1;
  for (int along_x = 2; along_x <= count; ++along_x) best = radius(along_x) < radius(best) ? along_x : best;
  const auto [nx, ny, nz] = counts.value_or(std::array<int, 3>{best, count, 1});
  model::TriangleSoup all;
  for (int n = 0; n < (counts ? nx * ny * nz : count); ++n) {
    const std::size_t which = static_cast<std::size_t>(n) % bodies.size();
    const Point at{n % nx * pitch[0], n / nx % ny * pitch[1], n / (nx * ny) * pitch[2]};
    const Point shift = at - boxes[which].centre();
    const int first = count_of(all.points);
    for (const Point& point : bodies[which].points) all.points.push_back(point + shift);
    for (auto triangle : bodies[which].triangles) {
      for (auto& corner : triangle) corner += first;
      all.triangles.push_back(triangle);
    }
  }
  return all;
}

Lattice row_lattice(const model::Projector& projector, double voxel_mm) {
  const double edge_mm = model::z_mm(projector, -0.5);
  const double phase_mm = edge_mm - std::floor(edge_mm / projector.pixel_mm + 1e-9) * projector.pixel_mm;
  return {false, std::max(phase_mm, 0.0) / voxel_mm};
}

model::Grid grid_around(const PlacedExtent& part, double voxel_mm, double radius_mm, const Lattice& lattice,
                        const std::string& subject) {
  const double odd = lattice.odd_side ? 1 : 0;
  const double half = std::ceil(std::max(part.radius_mm, radius_mm) / voxel_mm - 0.5 * odd - 1e-9) + 1;
  const double first = std::floor(part.box.low[2] / voxel_mm - lattice.z_phase + 1e-9);
  const double last = std::max(std::ceil(part.box.high[2] / voxel_mm - lattice.z_phase - 1e-9), first + 1);
  const double side = 2 * half + odd;
  if (side > most_voxels || last - first > most_slices) {
    throw Error{Fault::data, subject + ": " + format_number(side) + " x " + format_number(side) + " x " +
                                 format_number(last - first) + " voxels of " + format_number(voxel_mm) +
                                 " mm are more than " + std::to_string(most_voxels) + " per axis in " +
                                 std::to_string(most_slices) +
                                 " slices; check its unit, or use larger voxels or a smaller part"};
  }
  return model::centred_grid(static_cast<int>(side), static_cast<int>(side), static_cast<int>(last - first), voxel_mm,
                             (first + lattice.z_phase + 0.5) * voxel_mm);
}

void require_lit(double farthest_mm, const Writable& room, double voxel_mm, const std::string& subject,
                 const PlacementAdvice& advice) {
  require_radius(farthest_mm, room, voxel_mm, subject + ": its voxels reach", "give smaller voxels or a smaller scale",
                 advice.beyond);
}

void require_writable(const PlacedExtent& part, const Writable& room, double voxel_mm, const std::string& subject,
                      const PlacementAdvice& advice) {
  const Point mm = part.box.size();
  const Point middle = part.box.centre();
  const bool aside = std::hypot(middle[0], middle[1]) > room.radius_mm;
  const std::string remedy =
      advice.unit + (aside ? advice.off_axis : "") + smaller(advice, fitting_factor(part, room, voxel_mm));
  require_radius(part.radius_mm, room, voxel_mm,
                 subject + ": " + format_number(mm[0], 4) + " x " + format_number(mm[1], 4) + " x " +
                     format_number(mm[2] / advice.stretch_z, 4) + " mm, reaches",
                 remedy, advice.beyond);
  if (part.box.low[2] < room.low_mm - rounding_mm || part.box.high[2] > room.high_mm + rounding_mm) {
    const bool fits = part.box.size()[2] <= room.high_mm - room.low_mm + rounding_mm;
    throw Error{Fault::data,
                subject + ": spans z = " + format_number(part.box.low[2], 4) + " ... " +
                    format_number(part.box.high[2], 4) + " mm" +
                    (advice.stretch_z == 1 ? "" : " after stretching by " + format_number(advice.stretch_z, 4)) +
                    ", but the projector's rows cover " + format_number(room.low_mm, 4) + " ... " +
                    format_number(room.high_mm, 4) + " mm; " +
                    (fits ? advice.too_high : remedy + " to make it fit" + advice.too_tall)};
  }
}

void require_within(const PlacedExtent& insert, double vial_radius_mm, const std::string& subject) {
  if (insert.radius_mm <= vial_radius_mm) return;
  throw Error{Fault::data, subject + ": reaches " + format_number(insert.radius_mm, 4) +
                               " mm from the axis, beyond the vial's inner radius of " +
                               format_number(vial_radius_mm, 4) + " mm; check its unit and position"};
}

}  // namespace vam::solid
