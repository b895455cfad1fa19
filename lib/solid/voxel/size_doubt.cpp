// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/size_doubt.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.hpp"

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

std::string size_doubt(const Part& part, const FillSummary& content, const model::Grid& grid, double stretch_z,
                       const Writable& room, bool unit_known) {
  const Point size = part.extent.box.size();
  const double largest_mm = std::max({size[0], size[1], size[2] / stretch_z});
  const std::string unit = unit_known ? "" : likely_unit(largest_mm, room);
  if (content.solid_voxels == 0) {
    const double thinner = 0.5 * grid.voxel_mm * static_cast<double>(content.most);
    return part.subject + ": no voxel of " + format_number(grid.voxel_mm) + " mm is wholly inside the part, which is " +
           format_number(largest_mm, 3) + " mm large (a voxel is covered to " +
           format_number(static_cast<double>(content.most), 2) + " at most)" +
           (unit.empty() ? "; voxels of " + format_number(thinner, 2) + " mm or thicker walls may help" : unit);
  }
  const double lost = content.lost.voxels * std::pow(grid.voxel_mm, 3) / content.volume_mm3;
  if (unit.empty() && lost > 1e-3) {
    return part.subject + ": " + format_number(100 * lost, 2) +
           " % of the part is in walls too thin for the voxels: between z = " +
           format_number(grid.z_mm(content.lost.first - 0.5) / stretch_z, 3) + " and " +
           format_number(grid.z_mm(content.lost.end - 0.5) / stretch_z, 3) +
           " mm no voxel of theirs is half covered, and they will not be printed; voxels of " +
           format_number(grid.voxel_mm * static_cast<double>(content.lost.most), 2) + " mm or thicker walls may help";
  }
  return unit_known ? "" : unit_doubt(part.subject, "part", largest_mm, room);
}

}  // namespace vam::solid
