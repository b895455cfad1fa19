// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/size_doubt.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text/text.hpp"

namespace vam::solid {

namespace {

constexpr std::pair<const char*, double> units[] = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"in", 25.4}, {"um", 1e-3}};

/// "; is its unit m?"
std::string likely_unit(double largest_mm, const Writable& room) {
  if (largest_mm >= 0.1 * 2 * room.radius_mm) return "";
  std::vector<std::string> likely;
  for (const auto& [name, mm] : units) {
    const double widths = largest_mm * mm / (2 * room.radius_mm);
    if (mm != 1 && widths > 0.25 && widths < 12) likely.emplace_back(name);
  }
  return likely.empty() ? "" : "; is its unit " + join(likely, " or ") + "?";
}

/// "between z = 1 and 2 mm", of the print.
std::string heights(int first, int end, const model::Grid& grid, double stretch_z) {
  return "between z = " + format_number(grid.z_mm(first - 0.5) / stretch_z, 3) + " and " +
         format_number(grid.z_mm(end - 0.5) / stretch_z, 3) + " mm";
}

/// Of which these are so many across, in two digits.
double resolving_mm(const model::ThinPlaces& places, double voxels = model::narrow_voxels) {
  const double mm = places.mm / voxels;
  const double digit = std::pow(10, std::floor(std::log10(mm)) - 1);
  constexpr double rounding = 1e-6;
  return std::floor(mm / digit + rounding) * digit;
}

/// Of what voxels lose: such places of the part's own surface, or its relief; null where the surface does not tell.
const model::ThinPlaces* cause_of(const verdict::SubVoxelFeatures& unresolved,
                                  model::ThinPlaces model::PartSurface::*kind) {
  const auto& surface = unresolved.surface;
  if (!surface) return nullptr;
  const model::ThinPlaces& places = surface->places.*kind;
  if (places.are_below(model::lost_voxels, surface->voxel_mm)) return &places;
  return surface->has_relief() ? &surface->places.relief : nullptr;
}

constexpr const char* unknown = "whether they print is not judged";

/// "part.stl: walls of 0.27 mm are too fine for voxels of 0.3 mm, as near (1, 2, 3) mm, and may not print; voxels of
/// 0.14 mm resolve them": of so many voxels across.
std::string place_doubt(const std::string& subject, const std::string& kind, const std::string& outcome,
                        const model::ThinPlaces& places, double voxels, const model::Grid& grid, double stretch_z) {
  const auto& [x, y, z] = places.at_mm;
  return subject + ": " + kind + " of " + format_number(places.mm, 2) + " mm are too fine for voxels of " +
         format_number(grid.voxel_mm, 3) + " mm, as near (" + format_number(x, 3) + ", " + format_number(y, 3) + ", " +
         format_number(z / stretch_z, 3) + ") mm, and " + outcome + "; voxels of " +
         format_number(resolving_mm(places, voxels), 2) + " mm resolve them";
}

/// Of walls that are lost, if they are a thousandth of the part or more, and of rods.
std::string wall_doubt(const std::string& subject, const verdict::SubVoxelFeatures& unresolved, const model::Grid& grid,
                       double stretch_z) {
  const verdict::LostWalls& lost = unresolved.lost_walls;
  const std::string what = unresolved.loses_much()
                               ? format_number(100 * unresolved.lost_share(), 2) + " % of the part is in walls"
                               : "walls or rods are";
  const auto most = static_cast<double>(lost.most);
  const double thick = unresolved.loses_much() ? most : std::sqrt(most);  // of a rod its area is covered
  const model::ThinPlaces* cause = cause_of(unresolved, &model::PartSurface::walls);
  const double resolving = cause != nullptr ? resolving_mm(*cause) : grid.voxel_mm * thick;
  return subject + ": " + what + " too thin for the voxels: " + heights(lost.first, lost.end, grid, stretch_z) +
         " no voxel of theirs is half covered, and they will not be printed; voxels of " + format_number(resolving, 2) +
         " mm or thicker walls may help";
}

std::string thin_doubt(const std::string& subject, const verdict::SubVoxelFeatures& thin, const model::Grid& grid,
                       double stretch_z) {
  return subject + ": " + format_number(100 * thin.share(), 3) +
         " % of the part is in walls or gaps too thin for the voxels: " +
         heights(thin.first, thin.end, grid, stretch_z) +
         " no voxel of theirs is wholly inside or outside, and whether they print is not judged; smaller voxels "
         "resolve them";
}

std::string gap_doubt(const std::string& subject, const verdict::SubVoxelFeatures& unresolved, const model::Grid& grid,
                      double stretch_z) {
  const verdict::LostGaps& lost = unresolved.lost_gaps;
  const model::ThinPlaces* cause = cause_of(unresolved, &model::PartSurface::gaps);
  const double gap_mm = cause != nullptr ? cause->mm : grid.voxel_mm * static_cast<double>(lost.widest);
  const double by_width = cause != nullptr ? resolving_mm(*cause) : 0.5 * gap_mm;
  const double resolving = std::min(by_width, 0.75 * grid.voxel_mm);  // these voxels do not
  return subject + ": gaps of " + format_number(gap_mm, 2) +
         " mm are too narrow for the voxels: " + heights(lost.first, lost.end, grid, stretch_z) +
         " no voxel of theirs is more than three quarters free, and they will be printed shut; voxels of " +
         format_number(resolving, 2) + " mm resolve them";
}

}  // namespace

const std::vector<std::string>& unit_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& unit : units) list.emplace_back(unit.first);
    return list;
  }();
  return names;
}

double mm_per(const std::string& unit) {
  return std::find_if(std::begin(units), std::end(units), [&](const auto& one) { return unit == one.first; })->second;
}

std::string unit_doubt(const std::string& subject, const std::string& body, double largest_mm, const Writable& room) {
  const std::string unit = likely_unit(largest_mm, room);
  return unit.empty() ? ""
                      : subject + ": the " + body + " is only " + format_number(largest_mm, 3) + " mm large" + unit;
}

std::string finer_unit(double largest_mm, const Writable& room) {
  for (const auto& [name, mm] : units) {
    const double widths = largest_mm * mm / (2 * room.radius_mm);
    if (mm < 1 && widths > 0.05 && widths < 1.5) return std::string("is its unit ") + name + "?";
  }
  return "";
}

std::vector<std::string> resolution_doubts(const std::string& subject, const verdict::SubVoxelFeatures& unresolved,
                                           const model::Grid& grid, double stretch_z) {
  std::vector<std::string> doubts;
  const auto& surface = unresolved.surface;
  if (unresolved.loses_walls()) {
    doubts.push_back(wall_doubt(subject, unresolved, grid, stretch_z));
  } else if (surface && surface->places.walls.are_below(model::narrow_voxels, grid.voxel_mm)) {
    doubts.push_back(place_doubt(subject, "walls",
                                 surface->has_thin_walls() ? unknown : "may not print, as vam-score tells",
                                 surface->places.walls, model::narrow_voxels, grid, stretch_z));
  }
  if (unresolved.bridges_gaps()) {
    doubts.push_back(gap_doubt(subject, unresolved, grid, stretch_z));
  } else if (surface && surface->has_thin_gaps()) {
    doubts.push_back(place_doubt(subject, "gaps", unknown, surface->thin_gaps(), model::free_voxels, grid, stretch_z));
  } else if (surface && surface->places.gaps.are_below(model::narrow_voxels, grid.voxel_mm)) {
    doubts.push_back(place_doubt(subject, "gaps", "may be printed shut, as vam-score tells", surface->places.gaps,
                                 model::narrow_voxels, grid, stretch_z));
  }
  if (doubts.empty() && surface && surface->has_relief())
    doubts.push_back(place_doubt(subject, "ridges and grooves", unknown, surface->places.relief, model::narrow_voxels,
                                 grid, stretch_z));
  if (doubts.empty() && unresolved.leaves_doubt()) doubts.push_back(thin_doubt(subject, unresolved, grid, stretch_z));
  return doubts;
}

double resolving_voxel_mm(const FillSummary& content, const model::Grid& grid) {
  return 0.5 * grid.voxel_mm * static_cast<double>(content.most);
}

double telling_voxel_mm(const verdict::SubVoxelFeatures& unresolved, double voxel_mm) {
  double telling = 0.5 * voxel_mm;
  if (!unresolved.surface) return telling;
  const model::PartSurface& places = unresolved.surface->places;
  for (const auto& [thin, voxels] : {std::pair{places.walls, model::lost_voxels},
                                     {places.gaps, model::lost_voxels},
                                     {places.blocked, model::free_voxels},
                                     {places.relief, model::narrow_voxels}}) {
    if (thin.are_below(voxels, voxel_mm)) telling = std::min(telling, resolving_mm(thin, voxels));
  }
  return telling;
}

std::string size_doubt(const Part& part, const FillSummary& content, const model::Grid& grid, double stretch_z,
                       const Writable& room, bool unit_known) {
  const Point size = part.extent.box.size();
  const double largest_mm = std::max({size[0], size[1], size[2] / stretch_z});
  const std::string unit = unit_known ? "" : likely_unit(largest_mm, room);
  if (content.solid_voxels == 0) {
    return part.subject + ": no voxel of " + format_number(grid.voxel_mm) + " mm is wholly inside the part, which is " +
           format_number(largest_mm, 3) + " mm large (a voxel is covered to " +
           format_number(static_cast<double>(content.most), 2) + " at most)" +
           (unit.empty()
                ? "; voxels of " + format_number(resolving_voxel_mm(content, grid), 2) + " mm or thicker walls may help"
                : unit);
  }
  return unit_known ? "" : unit_doubt(part.subject, "part", largest_mm, room);
}

}  // namespace vam::solid
