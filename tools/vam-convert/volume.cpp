// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/volume.hpp"

#include <algorithm>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/progress.hpp"
#include "io/array/array_reader.hpp"
#include "io/vdb/gate.hpp"
#include "io/vdb/vdb.hpp"
#include "vam-convert/images.hpp"

namespace vam::convert_tool {

namespace {

model::Grid grid_of(const Options& options, const io::ArraySize& size) {
  const double voxel_mm = *options.voxel_mm;
  model::Grid grid =
      model::centred_grid(size.columns, size.rows, size.images, voxel_mm, -0.5 * (size.images - 1) * voxel_mm);
  if (!options.origin_mm.empty()) std::copy_n(options.origin_mm.begin(), 3, grid.origin_mm.begin());
  return grid;
}

Image upside_down(const Image& image) {
  Image turned(image.width, image.height);
  for (int y = 0; y < image.height; ++y) std::copy_n(image.row(y), image.width, turned.row(image.height - 1 - y));
  return turned;
}

void require_voxels(const std::string& name, const io::ArraySize& size) {
  constexpr int most = 65536;
  if (std::max({size.images, size.rows, size.columns}) <= most) return;
  throw Error{Fault::data, name + ": has " + std::to_string(size.columns) + " x " + std::to_string(size.rows) + " x " +
                               std::to_string(size.images) + " voxels; up to 65536 along an axis are read"};
}

}  // namespace

void make_volume(const cli::App& app, const Options& options, std::optional<io::FileType> type) {
  constexpr int slab = 8;
  const auto in = open_source(options, type, "zyx");
  require_voxels(options.input, in->size());
  const model::Grid grid = grid_of(options, in->size());
  io::SparseVolume volume(options.grid.empty() ? "target" : options.grid, grid);
  std::vector<float> slices;
  Image image;
  Progress progress("converting", grid.nz);
  for (int k = 0; k < grid.nz; k += slab) {
    slices.clear();
    const int count = std::min(slab, grid.nz - k);
    for (int i = 0; i < count; ++i) {
      if (!in->next(image)) {
        throw Error{Fault::data, options.input + ": ends after " + std::to_string(k + i) + " of " +
                                     std::to_string(grid.nz) + " slices; it is incomplete"};
      }
      if (in->are_frames()) image = upside_down(image);  // row 0 is at the top, voxels begin at the least y
      slices.insert(slices.end(), image.values.begin(), image.values.end());
    }
    volume.write_slices(k, count, slices.data());
    progress.tick(count);
  }
  io::require_usable(options.input, volume, io::TargetKind::grey);
  volume.units = options.units;
  volume.history = {app.history()};
  io::write_volume(options.output, volume);
}

}  // namespace vam::convert_tool
