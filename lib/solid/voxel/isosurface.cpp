// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/isosurface.hpp"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"

namespace vam::solid {

namespace {

constexpr int slab = 8;  // slices at a time: the edge of a leaf of the tree

void check_level(double level) {
  if (!std::isfinite(level)) {
    throw Error{Fault::usage, "threshold " + format_number(level) + " is not a number; give a finite dose"};
  }
}

/// work(k, count, values) over the whole volume.
template <class Work>
void over_slabs(const model::Grid& grid, const ReadSlices& read, const Work& work) {
  std::vector<float> buffer(grid.slice_size() * slab);
  for (int k = 0; k < grid.nz; k += slab) {
    const int count = std::min(slab, grid.nz - k);
    read(k, count, buffer.data());
    const auto end = buffer.begin() + static_cast<std::ptrdiff_t>(grid.slice_size() * static_cast<std::size_t>(count));
    if (!std::all_of(buffer.begin(), end, [](float v) { return std::isfinite(v); })) {
      throw Error{Fault::data, "slices " + std::to_string(k) + "..." + std::to_string(k + count - 1) +
                                   " hold values that are not finite; compute the volume again"};
    }
    work(k, count, buffer);
  }
}

/// level - value, so that the inside is negative like that of a level set; `away` far from any crossing.
openvdb::FloatGrid::Ptr below_level(const model::Grid& grid, const ReadSlices& read, double level) {
  const auto away = static_cast<float>(std::max(std::abs(level), 1e-30));
  auto field = openvdb::FloatGrid::create(away);
  over_slabs(grid, read, [&](int k, int count, std::vector<float>& values) {
    const auto at = static_cast<float>(level);
    for (float& v : values) v = at - v;
    const openvdb::CoordBBox box({0, 0, k}, {grid.nx - 1, grid.ny - 1, k + count - 1});
    const openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, values.data());
    openvdb::tools::copyFromDense(dense, *field, 0.0F);
  });
  return field;
}

}  // namespace

model::TriangleSoup isosurface(const model::Grid& grid, const ReadSlices& read, double level) {
  check_level(level);
  openvdb::initialize();
  const auto field = below_level(grid, read, level);
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*field, points, triangles, quads);
  model::TriangleSoup mesh;
  mesh.points.reserve(points.size());
  for (const auto& p : points)
    mesh.points.push_back({grid.x_mm(double(p.x())), grid.y_mm(double(p.y())), grid.z_mm(double(p.z()))});
  const auto add = [&](openvdb::Index32 a, openvdb::Index32 b, openvdb::Index32 c) {
    mesh.triangles.push_back({static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)});
  };
  mesh.triangles.reserve(triangles.size() + 2 * quads.size());
  for (const auto& t : triangles) add(t[0], t[1], t[2]);
  for (const auto& q : quads) {
    add(q[0], q[1], q[2]);
    add(q[0], q[2], q[3]);
  }
  return mesh;
}

model::TriangleSoup isosurface(const model::Volume& volume, double level) {
  const auto read = [&](int k, int count, float* out) {
    std::copy_n(volume.slice(k), volume.grid.slice_size() * static_cast<std::size_t>(count), out);
  };
  return isosurface(volume.grid, read, level);
}

PrintedPoints printed_points(const model::Grid& grid, const ReadSlices& read, double level) {
  check_level(level);
  PrintedPoints print;
  over_slabs(grid, read, [&](int k, int count, const std::vector<float>& values) {
    std::size_t at = 0;
    for (int z = k; z < k + count; ++z) {
      for (int y = 0; y < grid.ny; ++y) {
        for (int x = 0; x < grid.nx; ++x, ++at) {
          if (static_cast<double>(values[at]) < level) continue;
          print.points.points.push_back({grid.x_mm(x), grid.y_mm(y), grid.z_mm(z)});
          print.values.quality.push_back(values[at]);
        }
      }
    }
  });
  return print;
}

}  // namespace vam::solid
