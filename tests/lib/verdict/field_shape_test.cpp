// SPDX-License-Identifier: GPL-3.0-or-later
// Tunnels against closed forms, and against pieces, cavities and cells of a whole volume counted one by one.
#include "verdict/private/field_shape.hpp"

#include <cstdlib>

#include "testing.hpp"

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
  verdict::FieldCounter counter(of.nx, of.ny, level);
  for (int z = 0; z < of.nz; z += a_pass) {
    counter.add(std::min(a_pass, of.nz - z), of.values.data() + z * of.nx * of.ny);
    if (a_pass > 2) counter.connect();  // at any time
  }
  counter.connect();
  return counter.found().tunnels;
}

/// Distance inwards from a ring around z.
double ring(double x, double y, double z, double radius, double thick) {
  return thick - std::hypot(std::hypot(x, y) - radius, z);
}

/// Points of a volume, so many a voxel, with a margin, and whether each reaches the level.
struct Points {
  std::array<int, 3> size{};
  std::vector<char> solid;
  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(i);
  }
};

Points points_of(const Field& of, double level, int a_voxel) {
  Points points{{(of.nx + 1) * a_voxel + 1, (of.ny + 1) * a_voxel + 1, (of.nz + 1) * a_voxel + 1}, {}};
  for (const auto [k, j, i] : indices(points.size[2], points.size[1], points.size[0])) {
    double sum = 0;
    for (int n = 0; n < 8; ++n) {
      double weight = 1;
      std::array<int, 3> near{i, j, k};
      for (int axis = 0; axis < 3; ++axis) {
        const double part = static_cast<double>(near[axis] % a_voxel) / a_voxel;
        const bool up = (n >> axis & 1) != 0;
        near[axis] = near[axis] / a_voxel - 1 + (up ? 1 : 0);
        weight *= up ? part : 1 - part;
      }
      if (weight > 0) sum += weight * of.at(near[0], near[1], near[2]);
    }
    points.solid.push_back(sum >= level ? 1 : 0);
  }
  return points;
}

int pieces_of(Points points, char kind) {
  int pieces = 0;
  const auto& [nx, ny, nz] = points.size;
  for (std::size_t first = 0; first < points.solid.size(); ++first) {
    if (points.solid[first] != kind) continue;
    ++pieces;
    std::vector<std::size_t> open{first};
    points.solid[first] = 2;
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      const int i = static_cast<int>(at % nx);
      const int j = static_cast<int>(at / nx % ny);
      const int k = static_cast<int>(at / nx / ny);
      for (int n = 0; n < 27; ++n) {
        const std::array<int, 3> by{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        if (kind == 0 && std::abs(by[0]) + std::abs(by[1]) + std::abs(by[2]) != 1) continue;
        const std::array<int, 3> to{i + by[0], j + by[1], k + by[2]};
        if (to[0] < 0 || to[1] < 0 || to[2] < 0 || to[0] >= nx || to[1] >= ny || to[2] >= nz) continue;
        char& next = points.solid[points.index(to[0], to[1], to[2])];
        if (next != kind) continue;
        next = 2;
        open.push_back(points.index(to[0], to[1], to[2]));
      }
    }
  }
  return pieces;
}

/// Corners - edges + faces - cubes of the union of the cubes around them.
int euler_of(const Points& points) {
  int sum = 0;
  for (int k = 0; k + 1 < points.size[2]; ++k) {
    for (int j = 0; j + 1 < points.size[1]; ++j) {
      for (int i = 0; i + 1 < points.size[0]; ++i) {  // what is between a cube and the next ones upwards
        for (int n = 0; n < 8; ++n) {
          bool any = false;
          for (int m = 0; m < 8; ++m)
            any =
                any || ((m & ~n) == 0 && points.solid[points.index(i + (m & 1), j + (m >> 1 & 1), k + (m >> 2))] != 0);
          if (any) sum += (n == 0 || n == 3 || n == 5 || n == 6) ? -1 : 1;
        }
      }
    }
  }
  return sum;
}

std::int64_t tunnels_by_definition(const Field& of, double level, int a_voxel) {
  const Points points = points_of(of, level, a_voxel);
  return pieces_of(points, 1) + pieces_of(points, 0) - 1 - euler_of(points);
}

/// None where passages are too narrow for the points: more of them give another number.
std::optional<std::int64_t> known_tunnels(const Field& of, double level, int a_voxel) {
  const auto found = tunnels_by_definition(of, level, a_voxel);
  return found == tunnels_by_definition(of, level, 3 * a_voxel / 2) ? std::optional(found) : std::nullopt;
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

TEST_CASE("fields of any values have the tunnels of the whole volume, for every height of a pass") {
  std::mt19937 draw(8);  // NOLINT(cert-msc51-cpp): the same fields every time
  std::uniform_real_distribution<double> value(0.01, 1);
  int known = 0;
  int wrong = 0;
  int some_tunnels = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const Field some = field(4 + trial % 3, 4, 7, [&](double, double, double) { return value(draw); });
    const double level = 0.3 + 0.025 * trial;
    const auto found = counted(some, level, 7);
    some_tunnels += found > 2 ? 1 : 0;
    for (const int a_pass : {1, 4}) CHECK(counted(some, level, a_pass) == found);
    const auto wanted = known_tunnels(some, level, 12);
    known += wanted ? 1 : 0;
    wrong += wanted && found != *wanted ? 1 : 0;
  }
  CHECK(known > 15);
  CHECK(wrong <= 1);  // some passage may be too narrow for either number of points
  CHECK(some_tunnels > 5);
}

TEST_CASE("single cells of any values, whatever hangs together across their faces and inside") {
  std::mt19937 draw(7);  // NOLINT(cert-msc51-cpp): likewise
  std::uniform_real_distribution<double> value(0.01, 1);
  constexpr int cells = 400;
  int known = 0;
  for (int trial = 0; trial < cells; ++trial) {
    const Field cell = field(2, 2, 2, [&](double, double, double) { return value(draw); });
    const auto wanted = known_tunnels(cell, 0.5, 12);
    known += wanted ? 1 : 0;
    if (wanted) CHECK(counted(cell, 0.5, 2) == *wanted);
  }
  CHECK(known > 0.98 * cells);
}

TEST_CASE("inside a cell: a channel between opposite corners, through the ring of the others") {
  const auto tunnels = [](float ends, float others) {
    const Field cell{2, 2, 2, {ends, others, others, others, others, others, others, ends}};
    return counted(cell, 0.5, 2);
  };
  CHECK(tunnels(0.1F, 0.55F) == 1);  // the channel is open
  CHECK(tunnels(0.3F, 0.8F) == 0);   // shut
}

TEST_CASE("a volume of no slice, one slice, one column") {
  CHECK(verdict::FieldCounter(3, 3, 1).found().tunnels == 0);
  CHECK(counted(field(4, 3, 1, [](double, double, double) { return 2; }), 1, 1) == 0);
  CHECK(counted(field(5, 5, 1, [](double x, double y, double) { return std::hypot(x, y) < 1 ? 0 : 2; }), 1, 1) == 1);
  CHECK(counted(field(1, 1, 5, [](double, double, double z) { return z == 0 ? 0.5 : 2; }), 1, 2) == 0);
}
