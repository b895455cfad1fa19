// SPDX-License-Identifier: GPL-3.0-or-later
// Tunnels against closed forms, and against pieces, cavities and cells of a whole volume counted one by one.
#include "model/tunnels.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
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
  model::TunnelCounter counter(of.nx, of.ny, level);
  for (int z = 0; z < of.nz; z += a_pass) {
    counter.add(std::min(a_pass, of.nz - z), of.values.data() + z * of.nx * of.ny);
    if (a_pass > 2) counter.connect();  // at any time
  }
  counter.connect();
  return counter.tunnels();
}

/// Distance inwards from a ring around z.
double ring(double x, double y, double z, double radius, double thick) {
  return thick - std::hypot(std::hypot(x, y) - radius, z);
}

}  // namespace

TEST_CASE("a ball and a shell have no tunnel, a ring one, a plate its holes, whatever cavities are in it") {
  const auto of = [](const std::function<double(double, double, double)>& value) {
    const Field solid = field(30, 26, 24, [&](double x, double y, double z) { return 10 + value(x, y, z); });
    const std::int64_t found = counted(solid, 10, 24);
    for (const int a_pass : {1, 5}) CHECK(counted(solid, 10, a_pass) == found);
    return found;
  };
  CHECK(of([](double, double, double) { return -1; }) == 0);
  CHECK(of([](double, double, double) { return 1; }) == 0);
  CHECK(of([](double x, double y, double z) { return 7.2 - std::hypot(x, y, z); }) == 0);
  CHECK(of([](double x, double y, double z) { return ring(x, y, z, 7.1, 2.3); }) == 1);
  CHECK(of([](double x, double y, double z) { return 2 - std::abs(8.3 - std::hypot(x, y, z)); }) == 0);
  CHECK(of([](double x, double y, double z) {
          return std::max(ring(x - 6, y, z, 5, 1.7), ring(x + 6, y, z, 5, 1.7));
        }) == 2);
  CHECK(of([](double x, double y, double z) {
          return std::max(ring(x - 7.5, y, z, 4, 1.5), ring(x + 7.5, y, z, 4, 1.5));
        }) == 2);  // apart
  const auto plate = [](double x, double y, double z) {
    const double from_hole = std::hypot(std::remainder(x, 8), std::remainder(y, 9)) - 1.8;
    return std::min({4 - std::abs(z), from_hole, 14 - std::abs(x), 12 - std::abs(y)});
  };
  CHECK(of(plate) == 9);
  CHECK(of([&](double x, double y, double z) {
          const double from_bubble = std::hypot(std::remainder(x - 4, 8), std::remainder(y - 4.5, 9), z) - 1.2;
          return std::min(plate(x, y, z), from_bubble);
        }) == 9);
}

namespace {

/// Points every half voxel, with a margin, by their places; and how they hang together.
using Place = std::array<int, 3>;

int pieces_of(std::set<Place> points, bool by_faces) {
  int pieces = 0;
  for (; !points.empty(); ++pieces) {
    std::vector<Place> open{*points.begin()};
    points.erase(points.begin());
    while (!open.empty()) {
      const Place at = open.back();
      open.pop_back();
      for (int n = 0; n < 27; ++n) {
        const Place step{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        if (by_faces && std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]) != 1) continue;
        const Place next{at[0] + step[0], at[1] + step[1], at[2] + step[2]};
        if (points.erase(next) > 0) open.push_back(next);
      }
    }
  }
  return pieces;
}

/// Corners - edges + faces - cubes of the union of the cubes around them.
int euler_of(const std::set<Place>& points) {
  std::set<Place> cells;  // even coordinates are corners, odd ones within
  for (const auto& [i, j, k] : points)
    for (int n = 0; n < 27; ++n) cells.insert({2 * i + n % 3, 2 * j + n / 3 % 3, 2 * k + n / 9});
  int sum = 0;
  for (const Place& cell : cells)
    sum += std::count_if(cell.begin(), cell.end(), [](int c) { return c % 2 != 0; }) % 2 == 0 ? 1 : -1;
  return sum;
}

int tunnels_by_definition(const Field& of, double level) {
  std::set<Place> solid, rest;
  for (int k = -2; k <= 2 * of.nz; ++k) {
    for (int j = -2; j <= 2 * of.ny; ++j) {
      for (int i = -2; i <= 2 * of.nx; ++i) {
        double sum = 0;
        for (int n = 0; n < 8; ++n) {
          const auto near = [](int at, int up) { return (at + (up != 0 ? (at & 1) : -(at & 1))) / 2; };
          sum += of.at(near(i, n & 1), near(j, n >> 1 & 1), near(k, n >> 2));
        }
        (sum >= 8 * level ? solid : rest).insert({i, j, k});
      }
    }
  }
  return pieces_of(solid, false) + pieces_of(rest, true) - 1 - euler_of(solid);
}

}  // namespace

TEST_CASE("fields of any values have the tunnels of the whole volume, for every height of a pass") {
  std::mt19937 draw(5);  // NOLINT(cert-msc51-cpp): the same fields every time
  std::uniform_real_distribution<double> value(0.01, 1);
  int some_tunnels = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Field some = field(5 + trial % 3, 4, 7, [&](double, double, double) { return value(draw); });
    const double level = 0.3 + 0.01 * trial;
    const int wanted = tunnels_by_definition(some, level);
    some_tunnels += wanted > 2 ? 1 : 0;
    for (const int a_pass : {1, 4, 7}) CHECK(counted(some, level, a_pass) == wanted);
  }
  CHECK(some_tunnels > 20);
}

TEST_CASE("a volume of no slice, one slice, one column") {
  CHECK(model::TunnelCounter(3, 3, 1).tunnels() == 0);
  CHECK(counted(field(4, 3, 1, [](double, double, double) { return 2; }), 1, 1) == 0);
  CHECK(counted(field(5, 5, 1, [](double x, double y, double) { return std::hypot(x, y) < 1 ? 0 : 2; }), 1, 1) == 1);
  CHECK(counted(field(1, 1, 5, [](double, double, double z) { return z == 0 ? 0.5 : 2; }), 1, 2) == 0);
}
