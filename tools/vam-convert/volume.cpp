// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "base/text/text.hpp"
#include "io/array/array_file.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/gate.hpp"
#include "io/vdb/vdb.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/magnification.hpp"
#include "vam-convert/conversions.hpp"
#include "vam-convert/resliced.hpp"

namespace vam::convert_tool {

namespace {

/// Without --origin the middle of the array is at z = 0.
model::Grid grid_of(const Options& options, const io::ArraySize& size, double stretch_z) {
  const double voxel_mm = *options.voxel_mm;
  const int slices = static_cast<int>(std::max(std::lround(size.images * stretch_z), 1L));
  model::Grid grid = model::centred_grid(size.columns, size.rows, slices, voxel_mm, -0.5 * (slices - 1) * voxel_mm);
  const bool at_half = convention_of(options.from).volume_at_half;
  grid.origin_mm[0] = -axis_of(size.columns, at_half) * voxel_mm;
  grid.origin_mm[1] = -axis_of(size.rows, at_half) * voxel_mm;
  if (!options.origin_mm.empty()) {
    std::copy_n(options.origin_mm.begin(), 3, grid.origin_mm.begin());
    grid.origin_mm[2] = grid.origin_mm[2] * stretch_z + 0.5 * (stretch_z * (size.images - 1) - (slices - 1)) * voxel_mm;
  }
  return grid;
}

void require_voxels(const std::string& name, const model::Grid& grid) {
  constexpr int most = 65536;
  if (std::max({grid.nx, grid.ny, grid.nz}) <= most) return;
  throw Error{Fault::data, name + ": has " + std::to_string(grid.nx) + " x " + std::to_string(grid.ny) + " x " +
                               std::to_string(grid.nz) + " voxels; up to 65536 along an axis are read"};
}

// Prints are lower than their targets by the projector's vertical magnification, for which vam-slice has stretched
// them.
std::string height_doubt(const Options& options, const model::Printer& printer) {
  constexpr double least = 0.005;
  if (options.stretch_z || !(options.grid.empty() || options.grid == "target")) return "";
  const double factor = 1 / model::vertical_magnification(printer);
  if (std::abs(factor - 1) < least) return "";
  return io::input_name(options.input) + ": the print will be " + format_number(100 * std::abs(1 - 1 / factor), 2) +
         " % too " + (factor > 1 ? "short" : "tall") + ", as the projector's rays climb; --stretch-z " +
         format_number(factor, 5) + " corrects it, --stretch-z 1 takes the array as it is";
}

/// Grey levels of 8 or 16 bits, of which the largest is seldom meant as so large a coverage.
std::string scale_doubt(const Options& options, float most) {
  const bool level = most > 1 && most <= 65535 && most == std::floor(most);
  const bool target = options.grid.empty() || options.grid == "target";
  if (options.full_scale || !level || !target || options.units != "relative") return "";
  const int full = most <= 255 ? 255 : 65535;
  return io::input_name(options.input) + ": its values reach " + format_number(static_cast<double>(most)) +
         ", where a full voxel is 1; if they are grey levels, give --full-scale " + std::to_string(full);
}

/// The doubt about a target that is void everywhere.
std::string void_doubt(const Options& options, float most) {
  const bool target = options.grid.empty() || options.grid == "target";
  if (!target || model::label_of(most) != model::Label::void_) return "";
  return io::input_name(options.input) + ": its values reach " + format_number(static_cast<double>(most)) +
         ", where a full voxel is 1, and nothing of it is part; check the array" +
         (options.full_scale ? " and --full-scale" : "");
}

/// The doubt about a file that states its voxels, as NRRD does: both sizes, where they differ.
std::string voxel_doubt(const Options& options, double stated_mm) {
  constexpr double least = 1e-3;
  if (stated_mm == 0 || std::abs(stated_mm / *options.voxel_mm - 1) <= least) return "";
  const std::string stated = format_number(stated_mm, 4);
  return io::input_name(options.input) + ": states voxels of " + stated + " mm, and is read with --voxel " +
         format_number(*options.voxel_mm, 4) + "; give --voxel " + stated + " unless its header is wrong";
}

}  // namespace

void make_volume(const cli::App& app, const Options& options, std::optional<io::FileType> type,
                 const model::Printer& printer) {
  constexpr int slab = 8;
  const std::string height = height_doubt(options, printer);
  Slices in(options, type, "zyx");
  const std::string edges = voxel_doubt(options, in.source().info().pixel_mm);
  const double stretch_z = options.stretch_z.value_or(1);
  const model::Grid grid = grid_of(options, in.size(), stretch_z);
  require_voxels(options.input, grid);
  io::SparseVolume volume(options.grid.empty() ? "target" : options.grid, grid);
  const double first = 0.5 * (in.size().images - 1 - (grid.nz - 1) / stretch_z);
  Resliced slices(in, grid.nz, first, 1 / stretch_z, false);
  std::vector<float> values;
  float most = 0;
  Image image;
  Progress progress("converting", grid.nz);
  for (int k = 0; k < grid.nz; k += slab) {
    values.clear();
    const int count = std::min(slab, grid.nz - k);
    for (int i = 0; i < count; ++i) {
      slices.next(image);
      values.insert(values.end(), image.values.begin(), image.values.end());
    }
    volume.write_slices(k, count, values.data());
    most = std::max(most, *std::max_element(values.begin(), values.end()));
    progress.tick(count);
  }
  slices.left_out();
  io::check_values(options.input, volume, io::TargetKind::grey);
  volume.units = options.units;
  volume.history = {app.history()};
  if (options.stretch_z) volume.metadata["vam:stretch_z"] = format_number(stretch_z, 9);
  io::write_volume(options.output, volume);
  for (const std::string& doubt : {height, edges, scale_doubt(options, most), void_doubt(options, most)}) {
    if (!doubt.empty()) warn(doubt);
  }
}

}  // namespace vam::convert_tool
