// SPDX-License-Identifier: GPL-3.0-or-later
// The Euler characteristic against closed forms, and against the cubes of a whole volume counted one by one.
#include "model/euler.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <vector>

using namespace vam;

namespace {

struct Field {
  int nx, ny, nz;
  std::vector<float> values;
  [[nodiscard]] double at(int x, int y, int z) const {
    const bool in = x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz;
    return in ? static_cast<double>(values[(z * ny + y) * nx + x]) : 0;
  }
};

Field field(int nx, int ny, int nz, const std::function<double(double x, double y, double z)>& value) {
  Field made{nx, ny, nz, {}};
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x)
        made.values.push_back(static_cast<float>(value(x - 0.5 * (nx - 1), y - 0.5 * (ny - 1), z - 0.5 * (nz - 1))));
  return made;
}

std::int64_t counted(const Field& of, double level, int a_pass) {
  model::EulerCounter counter(of.nx, of.ny, level);
  for (int z = 0; z < of.nz; z += a_pass)
    counter.add(std::min(a_pass, of.nz - z), of.values.data() + z * of.nx * of.ny);
  return counter.characteristic();
}

/// Distance inwards from a ring around z.
double ring(double x, double y, double z, double radius, double thick) {
  return thick - std::hypot(std::hypot(x, y) - radius, z);
}

}  // namespace

TEST_CASE("a ball has 1, a ring 0, a shell 2, two rings that touch -1, a plate with holes 1 less each") {
  const auto of = [](const std::function<double(double, double, double)>& value) {
    const Field solid = field(30, 26, 24, [&](double x, double y, double z) { return 10 + value(x, y, z); });
    const std::int64_t found = counted(solid, 10, 24);
    for (const int a_pass : {1, 5}) CHECK(counted(solid, 10, a_pass) == found);
    return found;
  };
  CHECK(of([](double, double, double) { return -1; }) == 0);
  CHECK(of([](double, double, double) { return 1; }) == 1);  // closed at the edges
  CHECK(of([](double x, double y, double z) { return 7.2 - std::hypot(x, y, z); }) == 1);
  CHECK(of([](double x, double y, double z) { return ring(x, y, z, 7.1, 2.3); }) == 0);
  CHECK(of([](double x, double y, double z) { return 2 - std::abs(8.3 - std::hypot(x, y, z)); }) == 2);
  CHECK(of([](double x, double y, double z) {
          return std::max(ring(x - 6, y, z, 5, 1.7), ring(x + 6, y, z, 5, 1.7));
        }) == -1);
  CHECK(of([](double x, double y, double z) {
          return std::max(ring(x - 7.5, y, z, 4, 1.5), ring(x + 7.5, y, z, 4, 1.5));
        }) == 0);  // apart
  CHECK(of([](double x, double y, double z) {
          const double from_hole = std::hypot(std::remainder(x, 8), std::remainder(y, 9)) - 1.8;
          return std::min({1.5 - std::abs(z), from_hole, 14 - std::abs(x), 12 - std::abs(y)});
        }) == 1 - 9);
}

TEST_CASE("cells of any values give what the cubes of the whole volume do, for every height of a pass") {
  std::mt19937 draw(5);  // NOLINT(cert-msc51-cpp): the same fields every time
  std::uniform_real_distribution<double> value(0.01, 1);
  for (int trial = 0; trial < 30; ++trial) {
    const Field some = field(5 + trial % 3, 4, 6, [&](double, double, double) { return value(draw); });
    const double level = 0.3 + 0.02 * trial;
    std::set<std::array<int, 3>> cells;  // of the complex: even coordinates are corners, odd ones within
    for (int k = -1; k < 2 * some.nz; ++k) {
      for (int j = -1; j < 2 * some.ny; ++j) {
        for (int i = -1; i < 2 * some.nx; ++i) {
          double sum = 0;
          for (int n = 0; n < 8; ++n) {
            const auto near = [](int at, int up) { return (at + (up != 0 ? (at & 1) : -(at & 1))) / 2; };
            sum += some.at(near(i, n & 1), near(j, n >> 1 & 1), near(k, n >> 2));
          }
          if (sum < 8 * level) continue;
          for (int n = 0; n < 27; ++n) cells.insert({2 * i + n % 3, 2 * j + n / 3 % 3, 2 * k + n / 9});
        }
      }
    }
    std::int64_t wanted = 0;
    for (const auto& cell : cells) {
      const auto odd = std::count_if(cell.begin(), cell.end(), [](int c) { return c % 2 != 0; });
      wanted += odd % 2 == 0 ? 1 : -1;
    }
    for (const int a_pass : {1, 4, 6}) CHECK(counted(some, level, a_pass) == wanted);
  }
}

TEST_CASE("a volume of no slice, one slice, one column") {
  CHECK(model::EulerCounter(3, 3, 1).characteristic() == 0);
  CHECK(counted(field(4, 3, 1, [](double, double, double) { return 2; }), 1, 1) == 1);
  CHECK(counted(field(1, 1, 5, [](double, double, double z) { return z == 0 ? 0.5 : 2; }), 1, 2) == 2);
}
