// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/cavities.hpp"

#include "testing.hpp"

using namespace vam;

namespace {

// In slabs of 3 slices.
verdict::Cavities cavities(int n, const std::function<double(double x, double y, double z)>& coverage) {
  const model::Grid grid = model::centred_grid(n, n, n, 0.5, -0.25 * (n - 1));
  std::vector<float> values;
  for (const auto [k, j] : indices(n, n)) {
    for (int i = 0; i < n; ++i)
      values.push_back(static_cast<float>(coverage(grid.x_mm(i), grid.y_mm(j), grid.z_mm(k))));
  }
  verdict::CavityFinder finder(grid);
  for (int k = 0; k < n; k += 3) finder.add(std::min(3, n - k), values.data() + std::size_t(k) * grid.slice_size());
  return finder.found();
}

}  // namespace

TEST_CASE("a hollow sphere has one cavity, of its volume, around its middle") {
  const auto found = cavities(41, [](double x, double y, double z) {
    const double r = std::sqrt((x - 1) * (x - 1) + y * y + z * z);
    return r > 5 && r < 8 ? 1.0 : 0.0;
  });
  CHECK(found.count == 1);
  CHECK(std::abs(static_cast<double>(found.largest) / (4189.0) - 1) < 0.05);  // 4/3 pi 10^3 voxels
  CHECK(found.voxels == found.largest);
  CHECK(std::abs(found.at_mm[0] - 1) <= 0.5);
  CHECK(std::abs(found.at_mm[1]) <= 0.5);
  CHECK(std::abs(found.at_mm[2]) <= 0.5);
}

TEST_CASE("what is open has none: a tube, a cup at the border of the volume, a pinhole along the faces") {
  CHECK(cavities(21, [](double x, double y, double) { return std::hypot(x, y) > 2 ? 1.0 : 0.0; }).count == 0);
  CHECK(cavities(21, [](double x, double y, double z) { return std::hypot(x, y) > 2 || z < 0 ? 1.0 : 0.0; }).count ==
        0);
  const auto box = [](double x, double y, double z) { return std::max({std::abs(x), std::abs(y), std::abs(z)}); };
  const auto shell = [&](double x, double y, double z) { return box(x, y, z) > 2.1 && box(x, y, z) < 3.1 ? 1.0 : 0.0; };
  CHECK(cavities(21, shell).count == 1);
  CHECK(cavities(21, [&](double x, double y, double z) {
          return x == 0 && y == 0 && z > 0 ? 0.0 : shell(x, y, z);
        }).count == 0);
  CHECK(cavities(21, [](double, double, double) { return 0.0; }).count == 0);
  CHECK(cavities(21, [](double, double, double) { return 1.0; }).count == 0);
}

TEST_CASE("walls close a cavity from half coverage on, and 8 voxels make one") {
  const auto shell = [](double wall, double half_mm) {
    return [=](double x, double y, double z) {
      const double r = std::max({std::abs(x), std::abs(y), std::abs(z)});
      return r > half_mm && r < half_mm + 0.5 ? wall : 0.0;
    };
  };
  CHECK(cavities(20, shell(0.5, 1)).count == 1);
  CHECK(cavities(20, shell(0.4, 1)).count == 0);
  CHECK(cavities(20, shell(1, 0.4)).largest == 8);
  CHECK(cavities(21, shell(1, 0.4)).count == 0);  // a voxel
}

TEST_CASE("of several cavities the largest is told, wherever it ends") {
  const auto found = cavities(31, [](double x, double y, double z) {
    const bool low = std::abs(x) < 2.1 && std::abs(y) < 2.1 && std::abs(z + 4) < 2.1;  // 9 voxels wide
    const bool high = std::abs(x - 3) < 1.1 && std::abs(y) < 1.1 && std::abs(z - 3) < 1.1;
    return low || high ? 0.0 : 1.0;
  });
  CHECK(found.count == 2);
  CHECK(found.largest == 729);
  CHECK(found.voxels == 729 + 125);
  CHECK(found.at_mm[2] < 0);
}
