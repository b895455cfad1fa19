// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/trapped_resin.hpp"

#include <cmath>

#include "base/text/json.hpp"
#include "base/text/text.hpp"

namespace vam::solid {

namespace {

double printed_mm3(std::int64_t voxels, double voxel_mm, double stretch_z) {
  return static_cast<double>(voxels) * std::pow(voxel_mm, 3) / stretch_z;
}

}  // namespace

std::string trapped_resin(const verdict::Cavities& cavities, double voxel_mm, double stretch_z) {
  if (cavities.count == 0) return "";
  const auto number = [](double value) { return format_number(value, 3); };
  const auto& [x, y, z] = cavities.at_mm;
  const std::string how_many = cavities.count == 1 ? std::string("1 closed cavity of ")
                                                   : std::to_string(cavities.count) + " closed cavities of " +
                                                         number(printed_mm3(cavities.voxels, voxel_mm, stretch_z)) +
                                                         " mm3, the largest of ";
  return how_many + number(printed_mm3(cavities.largest, voxel_mm, stretch_z)) + " mm3 at x, y, z = " + number(x) +
         ", " + number(y) + ", " + number(z / stretch_z) + " mm, from which resin cannot drain";
}

Json trapped_resin_figures(const verdict::Cavities& cavities, double voxel_mm, double stretch_z) {
  if (cavities.count == 0) return nullptr;
  const auto& [x, y, z] = cavities.at_mm;
  Json trapped;
  trapped["cavities"] = cavities.count;
  trapped["volume_mm3"] = printed_mm3(cavities.voxels, voxel_mm, stretch_z);
  trapped["largest_mm3"] = printed_mm3(cavities.largest, voxel_mm, stretch_z);
  trapped["at_mm"] = {x, y, z / stretch_z};
  return trapped;
}

}  // namespace vam::solid
