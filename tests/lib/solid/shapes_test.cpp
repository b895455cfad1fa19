// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes against volumes in closed form, and the catalogue against bad input.
#include "solid/shapes/shapes.hpp"

#include <numeric>

#include "base/compute/parallel.hpp"
#include "solid/shapes/private/cell_fraction.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::solid;
using std::numbers::pi;

namespace {

struct Covered {
  model::Grid grid;
  std::vector<float> values;
  double volume_mm3 = 0;
};

Covered covered(const Field& field, double voxel_mm) {
  const double reach = std::max({field.box.high[0], field.box.high[1], -field.box.low[0], -field.box.low[1]});
  const int side = 2 * (static_cast<int>(std::ceil(reach / voxel_mm)) + 1);
  const int height = 2 * (static_cast<int>(std::ceil(std::max(field.box.high[2], -field.box.low[2]) / voxel_mm)) + 1);
  Covered result{.grid = model::centred_grid(side, side, height, voxel_mm, -0.5 * (height - 1) * voxel_mm)};
  result.values.resize(result.grid.size());
  cover(field, result.grid, 0, height, result.values.data());
  result.volume_mm3 = std::accumulate(result.values.begin(), result.values.end(), 0.0) * std::pow(voxel_mm, 3);
  return result;
}

std::string usage_error(const std::string& text) {
  return error_of([&] { (void)make_shape(text); }, Fault::usage);
}

// The hull of two balls, by integrating its profile.
double egg_volume(double low, double high, double distance) {
  const double b = (low - high) / distance;  // sine of the cone's half angle
  const double z_low = low * b;              // where the cone touches the balls
  const double z_high = distance + high * b;
  const double r_low = low * std::sqrt(1 - b * b);
  const double r_high = high * std::sqrt(1 - b * b);
  const auto cap = [](double radius, double from, double to) {
    return pi * (radius * radius * (to - from) - (to * to * to - from * from * from) / 3);
  };
  return cap(low, -low, z_low) + pi / 3 * (z_high - z_low) * (r_low * r_low + r_low * r_high + r_high * r_high) +
         cap(high, high * b, high);
}

// Of bars 0.4, 0.6 and 0.9 wide with gaps of their own width, 1.5 high on a base of 0.5, diameter 7, 0.4 from y = 0.
double resolution_volume() {
  const double radius = 3.5;
  const double apart = 0.4;
  const auto strip = [&](double x) {  // integral of sqrt(r^2 - x^2) - apart
    return 0.5 * (x * std::sqrt(radius * radius - x * x) + radius * radius * std::asin(x / radius)) - apart * x;
  };
  const auto cap = [&](double r) { return r * r * std::acos(apart / r) - apart * std::sqrt(r * r - apart * apart); };
  double area = 0;
  double at = -0.5 * (0.4 * 2 + 0.6 * 2 + 0.9);
  double ring = 0.4;
  for (const double width : {0.4, 0.6, 0.9}) {
    area += strip(at + width) - strip(at) + cap(ring + width) - cap(ring);
    at += 2 * width;
    ring += 2 * width;
  }
  return pi * radius * radius * 0.5 + 1.5 * area;
}

}  // namespace

TEST_CASE("a plane cuts a cube: closed forms") {
  CHECK(cube_fraction(0.25, {1, 0, 0}) == doctest::Approx(0.25).epsilon(1e-6));
  CHECK(cube_fraction(-0.25, {0, -2, 0}) == doctest::Approx(0.625).epsilon(1e-6));
  CHECK(cube_fraction(0, {1, 2, 3}) == doctest::Approx(0.5));
  // A corner: x + y + z < -1 within the unit cube about 0 is a tetrahedron of legs 1/2.
  CHECK(cube_fraction(1, {1, 1, 1}) == doctest::Approx(1.0 / 48));
  CHECK(cube_fraction(2, {1, 1, 1}) == 0);
  CHECK(cube_fraction(-2, {1, 1, 1}) == 1);
}

TEST_CASE("a plane cuts a cube: against counting points") {
  const std::vector<Point> normals{{1, 0.3, 0.1}, {-1, 0.9, 0.8}, {0.05, -0.1, 1}, {1, 1, -0.01}, {0.2, 0.7, 0.71}};
  constexpr int n = 100;
  for (const Point& normal : normals) {
    for (double offset = -0.9; offset <= 0.9; offset += 0.15) {
      int inside = 0;
      for (int c = 0; c < n * n * n; ++c) {
        const Point x{(c % n + 0.5) / n - 0.5, (c / n % n + 0.5) / n - 0.5, (c / n / n + 0.5) / n - 0.5};
        if (offset + dot(normal, x) < 0) ++inside;
      }
      // n^3 points resolve a cut to about its area over n: at most sqrt(3) / (2 n).
      CHECK(std::abs(cube_fraction(offset, normal) - inside / std::pow(n, 3)) < 0.87 / n);
    }
  }
}

TEST_CASE("volumes in closed form") {
  struct Case {
    const char* text;
    double volume;
  };
  const double egg_low = 5;
  const double egg_high = 0.62 * egg_low;
  const double egg_distance = 14 - egg_low - egg_high;
  const std::vector<Case> cases{
      {"sphere:diameter=5", pi / 6 * 125},
      {"sphere:diameter=1", pi / 6},
      {"cylinder:diameter=6,height=4.03", pi * 9 * 4.03},
      {"half-cylinder:diameter=6,height=4", pi * 18},
      {"hollow-cylinder:outer=6,inner=3.5,height=3", pi * 3 * (9 - 1.75 * 1.75)},
      {"box:x=3.01,y=4.02,z=2.03", 3.01 * 4.02 * 2.03},
      {"cone:bottom=6,top=2,height=5", pi / 3 * 5 * (9 + 3 + 1)},
      {"cone:bottom=6,top=0,height=5", pi / 3 * 5 * 9},
      {"torus:outer=8,tube=2", 2 * pi * pi * 3},
      {"disc-grid:period=2,radius=0.6,diameter=6,height=2", 5 * pi * 0.36 * 2},
      {"disc-grid:period=2,radius=0.6,diameter=7,height=2", 9 * pi * 0.36 * 2},
      {"resolution:finest=0.4,coarsest=0.9,steps=3,diameter=7,height=2,base=0.5", resolution_volume()},
      {"ladder:width=6,depth=2,rail=1,rung=0.5,gap=0.4,rungs=3", 2 * (2 * 3.1 + 3 * 4 * 0.5)},
      {"egg-shell:length=14,diameter=10,wall=0.8,opening=0",
       egg_volume(egg_low, egg_high, egg_distance) - egg_volume(egg_low - 0.8, egg_high - 0.8, egg_distance)},
  };
  for (const Case& c : cases) {
    CAPTURE(c.text);
    // Curved faces are resolved to second order and edges to an eighth of a voxel, so 2e-4 at 0.1 mm.
    CHECK(std::abs(covered(make_shape(c.text), 0.1).volume_mm3 / c.volume - 1) < 2e-4);
  }
}

TEST_CASE("a gyroid sheet has the volume that Weyl's tube formula gives") {
  // Per unit cell a: V = A t + (t^3 / 12) * integral of the Gaussian curvature = A t - (t^3 / 12) 16 pi (Euler
  // characteristic -8 per cubic cell), with the area A = 3.0911 a^2 of F = 0, integrated by the coarea formula (the
  // minimal surface itself has 3.0915). One whole cell within a large cylinder.
  const double a = 7;
  const double t = 1;
  const Field field = make_shape("gyroid:cell=7,sheet=1,diameter=40,height=40");
  constexpr int n = 96;
  const model::Grid grid = model::centred_grid(n, n, n, a / n, -0.5 * (n - 1) * a / n);
  std::vector<float> values(grid.size());
  cover(field, grid, 0, n, values.data());
  const double fraction = std::accumulate(values.begin(), values.end(), 0.0) / std::pow(n, 3);
  const double expected = (3.0911 * a * a * t - std::pow(t, 3) / 12 * 16 * pi) / std::pow(a, 3);
  CHECK(std::abs(fraction / expected - 1) < 1e-3);
}

TEST_CASE("every shape: inside its bounds, not empty, converging, empty and full exact") {
  for (const ShapeKind& kind : shape_kinds()) {
    CAPTURE(std::string{kind.name});
    const Field field = make_shape(std::string{kind.name});
    const Covered coarse = covered(field, 0.2);
    const Covered fine = covered(field, 0.1);
    CHECK(coarse.volume_mm3 > 1);
    // Both are accurate at features of a few voxels, so they agree far better than voxels of 0.2 mm would by counting.
    CHECK(coarse.volume_mm3 == doctest::Approx(fine.volume_mm3).epsilon(2e-3));
    double radius = 0;
    Bounds box;
    std::size_t exact = 0;
    std::size_t wrong = 0;
    for (std::size_t index = 0; index < fine.values.size(); ++index) {
      const float value = fine.values[index];
      if (!(value >= 0 && value <= 1)) ++wrong;
      if (value == 0 || value == 1) ++exact;
      if (value < 0.5F) continue;
      const auto i = static_cast<int>(index % static_cast<std::size_t>(fine.grid.nx));
      const auto j =
          static_cast<int>(index / static_cast<std::size_t>(fine.grid.nx) % static_cast<std::size_t>(fine.grid.ny));
      const auto k = static_cast<int>(index / fine.grid.slice_size());
      const Point p{fine.grid.x_mm(i), fine.grid.y_mm(j), fine.grid.z_mm(k)};
      box.add(p);
      radius = std::max(radius, std::hypot(p[0], p[1]));
    }
    CHECK(wrong == 0);
    CHECK(static_cast<double>(exact) > 0.6 * static_cast<double>(fine.values.size()));
    // Centres of voxels that are more than half full lie inside the bounds, up to a corner that fills half a voxel.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      CHECK(box.low[axis] > field.box.low[axis] - 0.03);
      CHECK(box.high[axis] < field.box.high[axis] + 0.03);
      CHECK(box.low[axis] < field.box.low[axis] + 0.35);  // and the bounds are tight
      CHECK(box.high[axis] > field.box.high[axis] - 0.35);
    }
    CHECK(radius < field.radius_mm + 0.03);
    CHECK(radius > field.radius_mm - 0.4);
  }
}

TEST_CASE("shapes without a closed form are as recorded") {
  // The sum of the field over 11^3 points of the bounds, and that of its size, which is that of no other shape. A part
  // that changes on purpose has other numbers.
  struct Recorded {
    const char* text;
    double sum, size;
  };
  const std::vector<Recorded> all{
      {"octet", 283.960644, 426.634092},
      {"octet:cell=3,strut=0.7,across=2,layers=3", 36.702379, 214.838048},
      {"ball-in-cage", 1226.411147, 1413.853906},
      {"ball-in-cage:diameter=9,strut=0.9,ball=4,meridians=3", 970.634170, 1072.604751},
      {"gyroid", 321.223969, 542.103691},
      {"boat", 1124.007966, 1249.770910},
      {"boat:length=20,wall=1", 1605.725666, 1785.387014},
      {"screwdriver", -449.449613, 716.920869},
      {"screwdriver:diameter=5,length=20,blade=1", -430.187472, 862.683629},
      {"handle", -353.670413, 1009.132548},
      {"disc-grid", 753.525338, 816.094895},
      {"ladder", -76.982273, 279.752273},
      {"resolution", 422.834186, 604.607683},
      {"egg-shell", 1125.624911, 1229.561297},
  };
  for (const Recorded& one : all) {
    CAPTURE(one.text);
    const Field field = make_shape(one.text);
    double sum = 0;
    double size = 0;
    constexpr int n = 11;
    for (int c = 0; c < n * n * n; ++c) {
      Point p{};
      for (std::size_t a = 0, rest = c; a < 3; ++a, rest /= n) {
        p[a] = field.box.low[a] + (static_cast<double>(rest % n) + 0.37) / n * (field.box.high[a] - field.box.low[a]);
      }
      sum += field.value(p);
      size += std::abs(field.value(p));
    }
    CHECK(sum == doctest::Approx(one.sum).epsilon(1e-7));
    CHECK(size == doctest::Approx(one.size).epsilon(1e-7));
  }
}

TEST_CASE("a voxel has the same coverage in a block as alone") {
  // 0.05 mm, so that blocks of four and of eight voxels are smooth in places, and windows that lie on the surface.
  constexpr int n = 32;
  constexpr double voxel_mm = 0.05;
  std::mt19937 random(5);
  for (const ShapeKind& kind : shape_kinds()) {
    CAPTURE(std::string{kind.name});
    const Field field = make_shape(std::string{kind.name});
    const auto anywhere = [&](std::size_t a) {
      return std::uniform_real_distribution<double>(field.box.low[a], field.box.high[a])(random);
    };
    Point middle{};
    do middle = {anywhere(0), anywhere(1), anywhere(2)};
    while (std::abs(field.value(middle)) > 0.2);
    model::Grid grid = model::centred_grid(n, n, n, voxel_mm, middle[2] - 0.5 * (n - 1) * voxel_mm);
    grid.origin_mm[0] += middle[0];
    grid.origin_mm[1] += middle[1];
    std::vector<float> values(grid.size());
    cover(field, grid, 0, n, values.data());
    double sum = 0;
    for (std::size_t index = 0; index < values.size(); ++index) {
      const auto v = static_cast<int>(index);
      const Point centre{grid.x_mm(v % n), grid.y_mm(v / n % n), grid.z_mm(v / n / n)};
      CubeValues corners{};
      for (unsigned c = 0; c < 8; ++c) corners[c] = field.value(centre + voxel_mm * corner_sign(c));
      const double difference = values[index] - cell_fraction(field, centre, voxel_mm, field.value(centre), corners);
      CHECK(std::abs(difference) < 0.02);
      sum += difference;
    }
    // The quadratics are held to half a per cent of a voxel between their nodes; a crease that grazes a corner of a
    // block may cost one voxel more.
    CHECK(std::abs(sum) / (n * n) < 1e-3);  // of a layer of voxels
  }
}

TEST_CASE("the same bytes for any number of threads and any division into slabs") {
  const Field field = make_shape("octet:cell=3,strut=0.7");
  const model::Grid grid = model::centred_grid(80, 80, 80, 0.1, -3.95);
  std::vector<float> whole(grid.size());
  std::vector<float> parts(grid.size());
  cover(field, grid, 0, grid.nz, whole.data());
  set_threads(1);
  for (int k = 0; k < grid.nz; k += 16) {
    cover(field, grid, k, 16, parts.data() + static_cast<std::size_t>(k) * grid.slice_size());
  }
  set_threads(0);
  CHECK(whole == parts);
}

TEST_CASE("transformed: the volume scales, the bounds follow") {
  const Field box = make_shape("box:x=4,y=2,z=3");
  const Field turned = transformed(box, scaling({1, 1, 1.04}) * rotation({30, 0, 45}) * scaling({1.5, 1.5, 1.5}));
  CHECK(covered(turned, 0.1).volume_mm3 == doctest::Approx(24 * 3.375 * 1.04).epsilon(5e-4));
  const Field upright = transformed(box, rotation({0, 0, 45}));
  CHECK(upright.box.high[0] == doctest::Approx(3 / std::sqrt(2)));
  CHECK(upright.radius_mm == doctest::Approx(std::sqrt(5)).epsilon(1e-4));
  // A lying cylinder's radius about z is that of its corners.
  const Field lying = transformed(make_shape("cylinder:diameter=4,height=6"), rotation({90, 0, 0}));
  CHECK(lying.radius_mm == doctest::Approx(std::hypot(2, 3)).epsilon(1e-4));
  CHECK(lying.box.high[2] == doctest::Approx(2));
}

TEST_CASE("errors of shapes state the valid range") {
  CHECK(has(usage_error("gyrod"), "did you mean gyroid?"));
  CHECK(has(usage_error("qqqqqqqqqqq"), "known: gyroid"));
  CHECK(has(usage_error("gyroid:cel=3"), "did you mean cell?"));
  CHECK(has(usage_error("gyroid:cell"), "NAME=VALUE"));
  CHECK(has(usage_error("gyroid:"), "no parameter"));
  CHECK(has(usage_error("gyroid:cell=x"), "not a number"));
  CHECK(has(usage_error("gyroid:cell=nan"), "not a number"));
  CHECK(has(usage_error("gyroid:cell=-1"), "outside 0.001"));
  CHECK(has(usage_error("octet:across=1.5"), "whole number"));
  CHECK(has(usage_error("hollow-cylinder:inner=10"), "inner must be below outer"));
  CHECK(has(usage_error(""), "unknown"));
}

TEST_CASE("a box under any map is bounded by its mapped corners") {
  Field field{.some = point_by_point([](const Point& p) {
                return std::max({1 - p[0], p[0] - 2, -3 - p[1], p[1], 4 - p[2], p[2] - 9});
              }),
              .box = {{1, -3, 4}, {2, 0, 9}}};
  field.radius_mm = field.ball_mm = 1e3;  // neither bounds the corners
  const Affine map{{{{0.9, -0.3, 0.2}, {0.5, 1.1, -0.4}, {-0.2, 0.6, 0.8}}}, {3, -7, 1}};
  Bounds want{{1e9, 1e9, 1e9}, {-1e9, -1e9, -1e9}};
  double radius_mm = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Point at =
        map({(corner & 1) != 0 ? 2.0 : 1.0, (corner & 2) != 0 ? 0.0 : -3.0, (corner & 4) != 0 ? 9.0 : 4.0});
    radius_mm = std::max(radius_mm, std::hypot(at[0], at[1]));
    for (std::size_t a = 0; a < 3; ++a) {
      want.low[a] = std::min(want.low[a], at[a]);
      want.high[a] = std::max(want.high[a], at[a]);
    }
  }
  const Field moved = transformed(field, map);
  for (std::size_t a = 0; a < 3; ++a) {
    CHECK(moved.box.low[a] == doctest::Approx(want.low[a]));
    CHECK(moved.box.high[a] == doctest::Approx(want.high[a]));
  }
  CHECK(moved.radius_mm == doctest::Approx(radius_mm).epsilon(2e-5));  // directions half a degree apart
  CHECK(moved.value(map({1.5, -1, 5})) == doctest::Approx(-0.5));      // half a millimetre inside the nearest face
  CHECK(moved.value(map({1.5, -1, 9.25})) == doctest::Approx(0.25));
}
