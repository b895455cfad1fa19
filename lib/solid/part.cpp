#include "solid/part.hpp"

#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "solid/shapes.hpp"

namespace vam::solid {

Part shape_part(const std::string& text, const Placement& placement, const Writable& room) {
  const Field shape = make_shape(text);
  Part part;
  part.subject = "--shape " + text;
  const Field placed = transformed(shape, place(shape, placement, room));
  part.extent = extent(placed);
  part.fill = [placed](const model::Grid& grid, const SliceSink& sink) {
    std::vector<float> slices(grid.slice_size() * slab);
    for (int k = 0; k < grid.nz; k += slab) {
      const int count = std::min(slab, grid.nz - k);
      cover(placed, grid, k, count, slices.data());
      sink(k, count, slices.data());
    }
  };
  return part;
}

Content fill(const Part& part, const model::Grid& grid, const SliceSink& sink) {
  Content content;
  double voxels = 0;
  part.fill(grid, [&](int k0, int count, const float* slices) {
    const float* value = slices;
    for (int row = 0; row < count * grid.ny; ++row) {
      const double y = grid.y_mm(row % grid.ny);
      for (int i = 0; i < grid.nx; ++i, ++value) {
        if (*value == 0) continue;
        voxels += *value;
        ++(*value == 1 ? content.solid_voxels : content.surface_voxels);
        if (*value >= 0.5F) content.radius_mm = std::max(content.radius_mm, std::hypot(grid.x_mm(i), y));
      }
    }
    sink(k0, count, slices);
  });
  if (voxels == 0) {
    throw Error{Fault::data, part.subject + ": covers no voxel of " + format_number(grid.voxel_mm) +
                                 " mm; check --unit and --voxel"};
  }
  content.volume_mm3 = voxels * grid.voxel_mm * grid.voxel_mm * grid.voxel_mm;
  return content;
}

}  // namespace vam::solid
