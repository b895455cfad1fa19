// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/isosurface.hpp"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"

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

/// A row of 2 n - 1 values from one of n: the values, and the means of neighbours.
void interpolate_row(const float* row, int n, float* out) {
  for (int x = 0; x + 1 < n; ++x) {
    *out++ = row[x];
    *out++ = 0.5F * (row[x] + row[x + 1]);
  }
  *out = row[n - 1];
}

void set_to_mean(const float* a, const float* b, std::size_t count, float* out) {
  std::transform(a, a + count, b, out, [](float p, float q) { return 0.5F * (p + q); });
}

/// The same voxels, and one between each two.
model::Grid halved(model::Grid grid) {
  grid.voxel_mm *= 0.5;
  for (int* n : {&grid.nx, &grid.ny, &grid.nz}) *n = 2 * *n - 1;
  return grid;
}

/// The trilinear field on voxels half as large.
class Halved {
 public:
  Halved(const model::Grid& coarse, const ReadSlices& read) : coarse_(coarse), read_(read), grid_(halved(coarse)) {}
  [[nodiscard]] const model::Grid& grid() const { return grid_; }
  /// Slices in rising order.
  void read(int k, int count, float* out) {
    const std::size_t size = grid_.slice_size();
    for (int n = k; n < k + count; ++n, out += size) {
      const std::vector<float>& below = slice(n / 2);
      if (n % 2 == 0) {
        std::copy(below.begin(), below.end(), out);
      } else {
        set_to_mean(below.data(), slice(n / 2 + 1).data(), size, out);
      }
    }
  }

 private:
  /// Of the coarse grid, interpolated in the slice; stays until the next but one.
  const std::vector<float>& slice(int k) {
    Slice& held = held_[k % 2];
    if (held.k == k) return held.values;
    read_(k, 1, read_slice_.data());
    for (int y = 0; y < coarse_.ny; ++y) {
      float* row = held.values.data() + 2 * product(y, grid_.nx);
      interpolate_row(read_slice_.data() + product(y, coarse_.nx), coarse_.nx, row);
      if (y > 0) set_to_mean(row - product(2, grid_.nx), row, static_cast<std::size_t>(grid_.nx), row - grid_.nx);
    }
    held.k = k;
    return held.values;
  }

  struct Slice {
    int k = -1;
    std::vector<float> values;
  };
  const model::Grid& coarse_;
  const ReadSlices& read_;
  model::Grid grid_;
  std::vector<float> read_slice_ = std::vector<float>(coarse_.slice_size());
  std::array<Slice, 2> held_{Slice{-1, std::vector<float>(grid_.slice_size())},
                             Slice{-1, std::vector<float>(grid_.slice_size())}};
};

ReadSlices slices_of(const model::Volume& volume) {
  return [&volume](int k, int count, float* out) {
    std::copy_n(volume.slice(k), volume.grid.slice_size() * static_cast<std::size_t>(count), out);
  };
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
  return isosurface(volume.grid, slices_of(volume), level);
}

model::TriangleSoup fine_isosurface(const model::Grid& grid, const ReadSlices& read, double level) {
  constexpr std::size_t most_triangles = 250'000;  // four times as many at half the size
  model::TriangleSoup mesh = isosurface(grid, read, level);
  if (mesh.triangles.empty() || mesh.triangles.size() > most_triangles) return mesh;
  Halved field(grid, read);
  return isosurface(
      field.grid(), [&](int k, int count, float* out) { field.read(k, count, out); }, level);
}

model::TriangleSoup fine_isosurface(const model::Volume& volume, double level) {
  return fine_isosurface(volume.grid, slices_of(volume), level);
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
