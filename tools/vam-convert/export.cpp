// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <vector>

#include "base/log/progress.hpp"
#include "io/array/array_file.hpp"
#include "io/exr/stack.hpp"
#include "io/vdb/vdb.hpp"
#include "vam-convert/conversions.hpp"

namespace vam::convert_tool {

void export_volume(const Options& options) {
  constexpr int slab = 16;
  const io::SparseVolume volume = io::read_volume(options.input, options.grid);
  const model::Grid& grid = volume.grid();
  io::ArrayWriter out(options.output, {grid.nz, grid.ny, grid.nx});
  std::vector<float> slices(grid.slice_size() * slab);
  Progress progress("converting", grid.nz);
  for (int k = 0; k < grid.nz; k += slab) {
    const int count = std::min(slab, grid.nz - k);
    volume.read_slices(k, count, slices.data());
    out.write(slices.data(), grid.slice_size() * static_cast<std::size_t>(count));
    progress.tick(count);
  }
  out.commit();
}

void export_stack(const Options& options) {
  io::StackReader in(options.input);
  io::ArrayWriter out(options.output, {in.info().count, in.info().height, in.info().width});
  Image image;
  Progress progress("converting", in.info().count);
  for (model::ImageInfo about; in.next(image, about); progress.tick()) out.write(image.values.data(), image.size());
  out.commit();
}

}  // namespace vam::convert_tool
