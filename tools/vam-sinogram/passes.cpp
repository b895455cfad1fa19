// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-sinogram/passes.hpp"

#include <algorithm>
#include <future>

#include "base/compute/memory.hpp"
#include "base/index.hpp"
#include "base/log/progress.hpp"
#include "model/grid_size.hpp"

namespace vam::sinogram_tool {

void for_each_pass(const io::SparseVolume& volume, const tomo::ProjectionSpec& spec,
                   const std::function<void(std::vector<Slab>& sinograms, int count)>& use) {
  const model::Grid& grid = volume.grid();
  const tomo::FilteredProjections projections(spec);
  const int slices = tomo::slabs_a_pass(spec.geometry) * lanes;
  // Two passes of slices that are read, one of them in slabs, and two of sinograms.
  require_memory(
      sizeof(float) * static_cast<double>(slices) *
          (3.0 * static_cast<double>(grid.slice_size()) + 2.0 * spec.geometry.columns * spec.geometry.angles),
      volume.name() + ": " + model::size_text(grid), "use larger voxels or fewer --angles");
  const auto read = [&](int first) {
    std::vector<float> dense(static_cast<std::size_t>(std::clamp(grid.nz - first, 0, slices)) * grid.slice_size());
    if (first < grid.nz) volume.read_slices(first, std::min(slices, grid.nz - first), dense.data());
    return dense;
  };
  Progress progress("projecting", grid.nz);
  auto ahead = std::async(std::launch::async | std::launch::deferred, read, 0);
  for (int first = 0; first < grid.nz; first += slices) {
    const std::vector<float> dense = ahead.get();
    ahead = std::async(std::launch::async | std::launch::deferred, read, first + slices);
    const int count = std::min(slices, grid.nz - first);
    std::vector<Slab> images;
    std::vector<Slab> sinograms;
    for (int s = 0; s < count; s += lanes) {
      images.emplace_back(grid.nx, grid.ny);
      sinograms.emplace_back(spec.geometry.columns, spec.geometry.angles);
      pack(dense.data() + product(s, grid.slice_size()), std::min(lanes, count - s), images.back());
    }
    projections.apply(images, sinograms);
    use(sinograms, count);
    progress.tick(count);
  }
}

std::vector<Image> unpacked(const std::vector<Slab>& slabs, int count) {
  std::vector<Image> images;
  std::vector<float> values;
  for (const Slab& slab : slabs) {
    const int used = std::min(lanes, count - count_of(images));
    const std::size_t size = slab.values.size() / lanes;
    values.resize(size * static_cast<std::size_t>(used));
    unpack(slab, used, values.data());
    for (int i = 0; i < used; ++i) {
      Image& image = images.emplace_back(slab.width, slab.height);
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(size) * i, size, image.values.begin());
    }
  }
  return images;
}

}  // namespace vam::sinogram_tool
