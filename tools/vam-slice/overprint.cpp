// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <vector>

#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "solid/voxel/insert_fit.hpp"
#include "vam-slice/part.hpp"

namespace vam::slice_tool {

namespace {

constexpr double most_shut = 0.02;  // of the lines: those at edges of the insert, which voxels round

std::string mm(const solid::Point& p, double stretch_z) {
  return "(" + format_number(p[0], 3) + ", " + format_number(p[1], 3) + ", " + format_number(p[2] / stretch_z, 3) + ")";
}

std::string size_text(const solid::Part& placed, double stretch_z) {
  const solid::Point size = placed.extent.box.size();
  return format_number(size[0], 3) + " x " + format_number(size[1], 3) + " x " + format_number(size[2] / stretch_z, 3) +
         " mm";
}

std::string miss_text(const solid::Part& placed, double stretch_z) {
  return placed.subject + ": misses the part; it measures " + size_text(placed, stretch_z) + " and is centred at " +
         mm(placed.extent.box.centre(), stretch_z) + " mm; check --insert-unit, --insert-scale and --insert-at";
}

void warn_of(const solid::InsertFit& fit, const solid::Part& placed, const Options& options) {
  const double stretch_z = options.placement.stretch_z;
  if (!fit.meets()) {
    warn(miss_text(placed, stretch_z));
  } else if (!options.clearance_mm && fit.overlap()) {
    warn(placed.subject + ": overlaps the part by " + format_number(fit.shared_mm3(stretch_z), 3) +
         " mm3; --cut-insert subtracts it");
  } else if (options.clearance_mm.value_or(0) > 0 && fit.shut_share() > most_shut) {
    warn(placed.subject + ": the clearance of " + format_number(*options.clearance_mm, 3) +
         " mm is too narrow for the voxels: on " + format_number(100 * fit.shut_share(), 3) +
         " % of the lines from the insert to the part no voxel is more than three quarters free, and resin cures "
         "there; voxels "
         "of " +
         format_number(0.5 * *options.clearance_mm, 2) + " mm resolve it");
  }
}

}  // namespace

bool is_beyond(const solid::Part& placed, const model::Grid& grid, double stretch_z) {
  const solid::Bounds& box = placed.extent.box;
  if (box.high[2] > grid.z_mm(-0.5) && box.low[2] < grid.z_mm(grid.nz - 0.5)) return false;
  warn(miss_text(placed, stretch_z) + "; no light passes it on its way to the part, and it is left out");
  return true;
}

solid::Part around(const solid::Part& part, const io::SparseVolume& insert, const Options& options) {
  if (!options.clearance_mm) return part;
  const auto read = [&insert](int k, float* out) { insert.read_slices(k, 1, out); };
  return solid::without_insert(part, read, *options.clearance_mm, options.placement.stretch_z);
}

Json insert_figures(const io::SparseVolume& target, const io::SparseVolume& insert, const solid::Part& placed,
                    const Options& options) {
  const model::Grid& grid = target.grid();
  const double stretch_z = options.placement.stretch_z;
  solid::InsertFit fit(grid, options.clearance_mm.value_or(0));
  std::vector<float> part(grid.slice_size());
  std::vector<float> opaque(grid.slice_size());
  for (int k = 0; k < grid.nz; ++k) {
    target.read_slices(k, 1, part.data());
    insert.read_slices(k, 1, opaque.data());
    fit.add(part.data(), opaque.data());
  }
  warn_of(fit, placed, options);
  Json figures = fit.figures(stretch_z);
  const solid::Point size = placed.extent.box.size();
  const solid::Point middle = placed.extent.box.centre();
  figures["size_mm"] = {size[0], size[1], size[2] / stretch_z};
  figures["middle_mm"] = {middle[0], middle[1], middle[2] / stretch_z};
  if (options.clearance_mm) {
    figures["clearance_mm"] = *options.clearance_mm;
    figures["clearance_shut"] = *options.clearance_mm > 0 ? fit.shut_share() : 0;
  }
  return figures;
}

}  // namespace vam::slice_tool
