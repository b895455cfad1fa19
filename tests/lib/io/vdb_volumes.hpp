// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes for the tests, and OpenVDB's own reader for their judge.
#pragma once

#include <doctest/doctest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "io/vdb/vdb.hpp"
#include "lib/io/scratch.hpp"

namespace vam::volumes {

using namespace vam::io;

// A ball of ones with a soft rim, a hollow in it, and zeros around: leaves, full tiles and empty space.
inline std::vector<float> ball(const model::Grid& grid) {
  std::vector<float> values;
  const double radius = 0.45 * std::min({grid.nx, grid.ny, grid.nz});
  for (int k = 0; k < grid.nz; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        const double r = std::hypot(i - 0.5 * grid.nx, j - 0.4 * grid.ny, k - 0.5 * grid.nz);
        values.push_back(static_cast<float>(std::clamp(radius - r, 0.0, 1.0)));
      }
    }
  }
  return values;
}

inline SparseVolume filled(const std::string& name, const model::Grid& grid, const std::vector<float>& values) {
  SparseVolume volume(name, grid);
  volume.write_slices(0, grid.nz, values.data());
  return volume;
}

inline std::vector<float> dense(const SparseVolume& volume) {
  std::vector<float> values(volume.grid().size(), -1.0F);
  volume.read_slices(0, volume.grid().nz, values.data());
  return values;
}

// The judge: OpenVDB's own file reader and its accessor, voxel by voxel.
inline openvdb::FloatGrid::Ptr by_openvdb(const std::string& path, const std::string& name) {
  openvdb::initialize();
  openvdb::io::File file(path);
  file.open(false);
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name));
  file.close();
  return grid;
}

inline void write_by_openvdb(const std::string& path, const openvdb::GridPtrVec& grids) {
  openvdb::io::File file(path);
  file.write(grids);
  file.close();
}

// The same by the blocks that pass by; the judge is read_volume.
inline std::vector<float> by_blocks(const std::string& path, const std::string& name) {
  std::vector<float> values;
  std::vector<int> times;  // that a voxel has come
  const SparseVolume volume = read_volume(path, name);
  const model::Grid& grid = volume.grid();
  if (grid.size() > 10'000'000) return {};  // a damaged shape
  values.assign(grid.size(), volume.background());
  times.assign(grid.size(), 0);
  for_blocks(volume, [&](const VoxelBlock& block) {
    for (int x = std::max(block.i, 0); x < std::min(block.i + block.edge, grid.nx); ++x) {
      for (int y = std::max(block.j, 0); y < std::min(block.j + block.edge, grid.ny); ++y) {
        for (int z = std::max(block.k, 0); z < std::min(block.k + block.edge, grid.nz); ++z) {
          const auto at = (static_cast<std::size_t>(z) * grid.ny + static_cast<std::size_t>(y)) *
                              static_cast<std::size_t>(grid.nx) +
                          static_cast<std::size_t>(x);
          const int place = ((x - block.i) * 8 + (y - block.j)) * 8 + (z - block.k);
          values[at] = block.values != nullptr ? block.values[place] : block.value;
          ++times[at];
        }
      }
    }
  });
  CHECK(std::all_of(times.begin(), times.end(), [](int count) { return count <= 1; }));
  return values;
}

}  // namespace vam::volumes
