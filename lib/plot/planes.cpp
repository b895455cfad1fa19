// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/planes.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace vam::plot {

namespace {

std::size_t across_axis(Plane plane) { return plane == Plane::axial ? 2 : plane == Plane::coronal ? 1 : 0; }

// One slice's part of a section: all of an axial one, one row of the others. Upwards is towards row 0.
void take(const model::Grid& grid, Plane plane, const float* slice, int k, int index, Image& image) {
  const auto at = [&](int i, int j) { return slice[flat_index(j, grid.nx, i)]; };
  if (plane == Plane::axial) {
    if (k != index) return;
    for (int j = 0; j < grid.ny; ++j) std::copy_n(&slice[product(j, grid.nx)], grid.nx, image.row(grid.ny - 1 - j));
    return;
  }
  float* row = image.row(grid.nz - 1 - k);
  for (int n = 0; n < image.width; ++n) row[n] = plane == Plane::coronal ? at(n, index) : at(index, n);
}

}  // namespace

Image plane_shape(const model::Grid& grid, Plane plane) {
  if (plane == Plane::axial) return {grid.nx, grid.ny};
  return plane == Plane::coronal ? Image(grid.nx, grid.nz) : Image(grid.ny, grid.nz);
}

int plane_count(const model::Grid& grid, Plane plane) {
  return plane == Plane::axial ? grid.nz : plane == Plane::coronal ? grid.ny : grid.nx;
}

double plane_mm(const model::Grid& grid, Plane plane, double index) {
  return grid.origin_mm[across_axis(plane)] + grid.voxel_mm * index;
}

int plane_index(const model::Grid& grid, Plane plane, double mm) {
  const double index = std::round((mm - plane_mm(grid, plane, 0)) / grid.voxel_mm);
  return static_cast<int>(std::clamp(index, 0.0, plane_count(grid, plane) - 1.0));
}

PlaneAxes plane_axes(Plane plane) {
  if (plane == Plane::axial) return {"x", "y", "z"};
  return plane == Plane::coronal ? PlaneAxes{"x", "z", "y"} : PlaneAxes{"y", "z", "x"};
}

Spot plane_origin_mm(const model::Grid& grid, Plane plane) {
  const auto& o = grid.origin_mm;
  if (plane == Plane::axial) return {o[0], o[1]};
  return plane == Plane::coronal ? Spot{o[0], o[2]} : Spot{o[1], o[2]};
}

std::array<int, 2> plane_column(const model::Grid& grid, Plane plane, int index, int x, int y) {
  if (plane == Plane::axial) return {x, grid.ny - 1 - y};
  return plane == Plane::coronal ? std::array<int, 2>{x, index} : std::array<int, 2>{index, x};
}

std::vector<Image> planes(const io::SparseVolume& volume, Plane plane, const std::vector<int>& indices) {
  const model::Grid& grid = volume.grid();
  std::vector<Image> images(indices.size(), plane_shape(grid, plane));
  constexpr int slab = 8;
  std::vector<float> slices(grid.slice_size() * slab);
  for (int k0 = 0; k0 < grid.nz; k0 += slab) {
    const int count = std::min(slab, grid.nz - k0);
    const bool wanted = plane != Plane::axial ||
                        std::any_of(indices.begin(), indices.end(), [&](int k) { return k >= k0 && k < k0 + count; });
    if (!wanted) continue;
    volume.read_slices(k0, count, slices.data());
    for (int k = k0; k < k0 + count; ++k) {
      const float* slice = slices.data() + static_cast<std::size_t>(k - k0) * grid.slice_size();
      for (std::size_t n = 0; n < indices.size(); ++n) take(grid, plane, slice, k, indices[n], images[n]);
    }
  }
  return images;
}

std::vector<std::vector<ContourPiece>> outlines(const io::SparseVolume& target, const model::Grid& grid, Plane plane,
                                                const std::vector<double>& places_mm) {
  const model::Grid& from = target.grid();
  std::vector<int> indices;
  for (const double mm : places_mm) indices.push_back(plane_index(from, plane, mm));
  const auto sections = planes(target, plane, indices);
  const Image shape = plane_shape(grid, plane);
  const Spot from_mm = plane_origin_mm(from, plane);
  const Spot to_mm = plane_origin_mm(grid, plane);
  std::vector<std::vector<ContourPiece>> result(places_mm.size());
  for (std::size_t n = 0; n < places_mm.size(); ++n) {
    if (std::abs(plane_mm(from, plane, indices[n]) - places_mm[n]) > 0.51 * from.voxel_mm) continue;
    const int last_row = sections[n].height - 1;
    const auto moved = [&](Spot s) {
      const double right_mm = from_mm.x + from.voxel_mm * s.x;
      const double up_mm = from_mm.y + from.voxel_mm * (last_row - s.y);
      return Spot{(right_mm - to_mm.x) / grid.voxel_mm, shape.height - 1 - (up_mm - to_mm.y) / grid.voxel_mm};
    };
    for (const auto& piece : contour(sections[n], 0.5F)) {
      const ContourPiece there{moved(piece.from), moved(piece.to)};
      const bool inside = std::min({there.from.x, there.to.x, there.from.y, there.to.y}) > -0.5 &&
                          std::max(there.from.x, there.to.x) < shape.width - 0.5 &&
                          std::max(there.from.y, there.to.y) < shape.height - 0.5;
      if (inside) result[n].push_back(there);
    }
  }
  return result;
}

}  // namespace vam::plot
