// SPDX-License-Identifier: GPL-3.0-or-later
#include <numeric>

#include "io/vdb/vdb.hpp"
#include "lib/io/vdb_volumes.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace vam::volumes;

TEST_CASE("a coarser voxel is the mean of the eight that it covers") {
  const model::Grid grid = model::centred_grid(5, 4, 19, 0.1);
  std::vector<float> fine(grid.size());
  std::iota(fine.begin(), fine.end(), 1.0F);
  SparseVolume volume = filled("insert", grid, fine);
  volume.history = {"made"};
  const SparseVolume coarse = coarser(volume);
  CHECK(coarse.name() == "insert");
  CHECK(coarse.history == volume.history);
  REQUIRE(coarse.grid().nx == 3);
  REQUIRE(coarse.grid().nz == 10);
  const std::vector<float> values = dense(coarse);
  const auto at = [&](int i, int j, int k) { return static_cast<std::size_t>((k * grid.ny + j) * grid.nx + i); };
  const auto mean = [&](int i, int j, int k) {  // beyond the grid nothing is covered
    float sum = 0;
    for (int n = 0; n < 8; ++n) {
      const int x = 2 * i + n % 2, y = 2 * j + n / 2 % 2, z = 2 * k + n / 4;
      if (x < grid.nx && y < grid.ny && z < grid.nz) sum += fine[at(x, y, z)];
    }
    return sum / 8;
  };
  std::size_t n = 0;
  for (const auto [k, j, i] : indices(10, 2, 3)) CHECK(values[n++] == doctest::Approx(mean(i, j, k)));
}
