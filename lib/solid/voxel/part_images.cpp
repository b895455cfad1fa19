// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "solid/voxel/part.hpp"

namespace vam::solid {

namespace {

PlacedExtent image_extent(const ImageStack& stack, double voxel_mm, double stretch_z) {
  PlacedExtent result;
  for (int k = 0; k < stack.count; ++k) {
    const Image image = stack.read(k);
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) {
        if (image(column, row) == 0) continue;
        // The far corner of the pixel.
        const double x = (column + 0.5 - 0.5 * image.width) * voxel_mm;
        const double y = (0.5 * image.height - row - 0.5) * voxel_mm;
        const double z = (k + 0.5 - 0.5 * stack.count) * voxel_mm;
        for (const double side : {-0.5, 0.5}) {
          result.box.add({x + side * voxel_mm, y + side * voxel_mm, (z + side * voxel_mm) * stretch_z});
        }
        result.radius_mm =
            std::max(result.radius_mm, std::hypot(std::abs(x) + 0.5 * voxel_mm, std::abs(y) + 0.5 * voxel_mm));
      }
    }
  }
  return result;
}

// Adds share times an image to a slice, its centre on the axis; in y half a voxel off where its sides differ in parity.
// Pixels outside the grid are empty (the grid holds the extent).
void add_image(const Image& image, float share, const model::Grid& grid, float* slice) {
  const int left = floor_int((grid.nx - image.width) / 2.0);
  const int front = floor_int((grid.ny - image.height) / 2.0);
  for (int row = 0; row < image.height; ++row) {
    const int j = front + image.height - 1 - row;
    if (j < 0 || j >= grid.ny) continue;
    const int first = std::max(0, -left);
    const int last = std::min(image.width, grid.nx - left);
    float* line = slice + std::ptrdiff_t{j} * grid.nx + left;
    for (int column = first; column < last; ++column) line[column] += share * image(column, row);
  }
}

void fill_images(const ImageStack& stack, double stretch_z, const model::Grid& grid, const SliceSink& sink) {
  std::vector<float> slices(grid.slice_size() * slab);
  Image image;
  int held = -1;
  for (int k0 = 0; k0 < grid.nz; k0 += slab) {
    const int count = std::min(slab, grid.nz - k0);
    std::fill(slices.begin(), slices.end(), 0.0F);
    for (int s = 0; s < count; ++s) {
      // The slice's lower and upper face in images.
      const auto to_image = [&](double k) { return grid.z_mm(k) / (stretch_z * grid.voxel_mm) + 0.5 * stack.count; };
      const double low = to_image(k0 + s - 0.5);
      const double high = to_image(k0 + s + 0.5);
      float* slice = slices.data() + product(s, grid.slice_size());
      const int last = std::min(stack.count - 1, ceil_int(high - 1e-9) - 1);
      for (int p = std::max(0, floor_int(low + 1e-9)); p <= last; ++p) {
        if (p != held) image = stack.read(held = p);
        const double share = (std::min<double>(high, p + 1) - std::max<double>(low, p)) / (high - low);
        add_image(image, static_cast<float>(share), grid, slice);
      }
    }
    for (float& value : slices) value = value > 1 - 1e-6F ? 1.0F : value;  // shares that add up to 1 but for rounding
    sink(k0, count, slices.data());
  }
}

}  // namespace

Part image_part(ImageStack stack, const std::string& subject, double voxel_mm, double stretch_z) {
  Part part;
  part.subject = subject;
  part.map = scaling({1, 1, stretch_z});
  part.extent = image_extent(stack, voxel_mm, stretch_z);
  if (part.extent.radius_mm == 0) throw Error{Fault::data, subject + ": all images are black"};
  part.lattice = {stack.width % 2 != 0, 0.5 * (stack.count % 2)};
  part.fill = [stack = std::move(stack), stretch_z](const model::Grid& grid, const SliceSink& sink) {
    fill_images(stack, stretch_z, grid, sink);
    return Vote{};
  };
  return part;
}

}  // namespace vam::solid
