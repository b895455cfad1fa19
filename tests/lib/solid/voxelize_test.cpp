// SPDX-License-Identifier: GPL-3.0-or-later
// Coverage against exact volumes, and what damage does to it.
#include "solid/voxel/voxelize.hpp"

#include <utility>

#include "base/compute/parallel.hpp"
#include "oracle/convex.hpp"
#include "oracle/meshes.hpp"
#include "solid/mesh/repair.hpp"
#include "solid/voxel/placement.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::solid;
using model::TriangleSoup;

namespace {

struct Result {
  std::vector<float> values;
  Repair repair;
  Vote vote;

  [[nodiscard]] double sum() const {
    double total = 0;
    for (const float v : values) total += v;
    return total;
  }
};

Result voxels(TriangleSoup mesh, const model::Grid& grid) {
  Result result{.repair = repair(mesh, "test")};
  result.values.reserve(grid.size());
  result.vote = voxelize(mesh, grid, result.repair.closed() ? Fill::exact : Fill::vote, result.repair.shared,
                         [&](int k0, int count, const float* slices) {
                           REQUIRE(static_cast<std::size_t>(k0) * grid.slice_size() == result.values.size());
                           result.values.insert(result.values.end(), slices,
                                                slices + static_cast<std::size_t>(count) * grid.slice_size());
                         });
  REQUIRE(result.values.size() == grid.size());
  return result;
}

model::Grid cube_grid(int side, double voxel = 1) {
  return model::centred_grid(side, side, side, voxel, -0.5 * (side - 1) * voxel);
}

// Share of the part's voxels whose coverage is wrong by more than a half.
double grossly_wrong(const std::vector<float>& got, const std::vector<float>& want) {
  long wrong = 0;
  long part = 0;
  for (std::size_t i = 0; i < want.size(); ++i) {
    if (want[i] > 0) ++part;
    if (std::abs(got[i] - want[i]) > 0.5F) ++wrong;
  }
  return static_cast<double>(wrong) / static_cast<double>(part);
}

// A turned box as half spaces and as a mesh.
struct Turned {
  std::vector<vam::oracle::HalfSpace> planes;
  TriangleSoup mesh;
};
Turned turned_box(const Vector3& half, const Affine& turn) {
  Turned result{.mesh = vam::oracle::box(-1.0 * half, half)};
  for (Vector3& p : result.mesh.points) p = turn(p);
  const Affine linear{turn.linear, {}};
  for (std::size_t a = 0; a < 3; ++a) {
    for (const double sign : {-1.0, 1.0}) {
      Vector3 axis{};
      axis[a] = sign;
      const Vector3 normal = linear(axis);
      result.planes.push_back({normal, half[a] + dot(normal, turn.shift)});
    }
  }
  return result;
}

}  // namespace

TEST_CASE("a sphere of 80,000 triangles has the volume of its mesh") {
  const TriangleSoup mesh = vam::oracle::sphere(45, 142);
  REQUIRE(mesh.triangles.size() > 80000);
  const Result result = voxels(mesh, cube_grid(96));
  CHECK(result.repair.closed());
  // The limit is 1e-4; what is left is the rounding of 900,000 floats.
  CHECK(std::abs(result.sum() / vam::oracle::signed_volume(mesh) - 1) < 1e-6);
}

TEST_CASE("every voxel of turned boxes against cutting cubes with half spaces") {
  for (const Vector3& turn :
       {Vector3{0, 0, 0}, Vector3{10, 20, 30}, Vector3{45, 0, 0}, Vector3{0, 0, 45}, Vector3{1e-7, 0, 1e-5}}) {
    CAPTURE(turn[0]);
    Affine map = rotation(turn);
    map.shift = {0.3, -0.2, 0.13};
    const Turned body = turned_box({5, 3.25, 4}, map);
    const model::Grid grid = cube_grid(20, 0.8);
    for (const Fill fill : {Fill::exact, Fill::vote}) {
      std::vector<float> values;
      (void)voxelize(body.mesh, grid, fill, Bounds{}, [&](int, int count, const float* slices) {
        values.insert(values.end(), slices, slices + static_cast<std::size_t>(count) * grid.slice_size());
      });
      for (const auto [k, j, i] : indices(grid.nz, grid.ny, grid.nx)) {
        const double want =
            vam::oracle::shared_volume({grid.x_mm(i), grid.y_mm(j), grid.z_mm(k)}, grid.voxel_mm, body.planes) /
            std::pow(grid.voxel_mm, 3);
        const auto at = static_cast<std::size_t>((k * grid.ny + j) * grid.nx + i);
        CHECK(std::abs(values[at] - want) < 2e-6);  // the snapping to 0 and 1, and float
      }
    }
  }
}

TEST_CASE("a sphere's surface against counting points") {
  const double radius = 13.3;
  const TriangleSoup mesh = vam::oracle::sphere(radius, 300);  // sagitta radius (pi / 600)^2 / 2 = 2e-4 voxels
  const model::Grid grid = cube_grid(30);
  const Result result = voxels(mesh, grid);
  constexpr int n = 24;
  double square = 0;
  long surface = 0;
  for (const auto [k, j, i] : indices(30, 30, 30)) {
    const double centre = std::hypot(grid.x_mm(i), grid.y_mm(j), grid.z_mm(k));
    const auto at = static_cast<std::size_t>((k * 30 + j) * 30 + i);
    if (std::abs(centre - radius) > 0.9) {
      CHECK(result.values[at] == (centre < radius ? 1.0F : 0.0F));
      continue;
    }
    int inside = 0;
    for (int s = 0; s < n * n * n; ++s) {
      const double x = grid.x_mm(i) + (s % n + 0.5) / n - 0.5;
      const double y = grid.y_mm(j) + (s / n % n + 0.5) / n - 0.5;
      const double z = grid.z_mm(k) + (s / n / n + 0.5) / n - 0.5;
      if (x * x + y * y + z * z < radius * radius) ++inside;
    }
    square += std::pow(result.values[at] - inside / std::pow(n, 3), 2);
    ++surface;
  }
  CHECK(std::sqrt(square / static_cast<double>(surface)) < 0.002);  // required: 0.01; counting 24^3 points errs 0.001
}

TEST_CASE("a damaged mesh leaves at most a voxel in a thousand grossly wrong") {
  const model::Grid grid = cube_grid(100);
  const double radius = 44;
  const TriangleSoup whole = vam::oracle::lumpy_sphere(radius, 100, 0.05);
  const std::vector<float> want = voxels(whole, grid).values;
  const double hole = 0.08 * radius;  // a diameter of 8 % of the part's

  struct Case {
    const char* name;
    TriangleSoup mesh;
    bool closed;  // repair is expected to close it
  };
  const std::vector<Case> cases{
      {"hole in the side", vam::oracle::punched(whole, {radius, 0, 0}, hole), false},
      {"hole at the top", vam::oracle::punched(whole, {0, 0, radius}, hole), false},
      {"hole at a slant", vam::oracle::punched(whole, {0.577 * radius, 0.577 * radius, 0.577 * radius}, hole), false},
      {"facets missing", vam::oracle::without(whole, 0.005, 1), false},
      {"all facets flipped", vam::oracle::flipped(whole, 1, 1), true},
      {"some facets flipped", vam::oracle::flipped(whole, 0.01, 2), true},
      {"half of the facets flipped", vam::oracle::flipped(whole, 0.49, 3), true},
      {"some facets flipped, in an STL file", vam::oracle::unwelded(vam::oracle::flipped(whole, 0.01, 4)), true},
      {"cracks of rounding", vam::oracle::cracked(whole, 1e-5 * radius, 5), true},
      {"cracks that are not welded", vam::oracle::cracked(whole, 2e-3 * radius, 6), false},
      {"cracks, all inside out", vam::oracle::flipped(vam::oracle::cracked(whole, 2e-3 * radius, 6), 1, 1), false},
      {"all facets twice", vam::oracle::repeated(whole, 1, 7), true},
      {"some facets twice", vam::oracle::repeated(whole, 0.1, 8), true},
      {"some facets twice, once turned over",
       vam::oracle::join(whole, vam::oracle::flipped(vam::oracle::without(whole, 0.9, 9), 1, 9)), true},
      {"missing and flipped", vam::oracle::flipped(vam::oracle::without(whole, 0.005, 10), 0.01, 11), false},
      {"missing, all inside out", vam::oracle::flipped(vam::oracle::without(whole, 0.005, 12), 1, 1), false},
  };
  for (const Case& c : cases) {
    CAPTURE(std::string(c.name));
    const Result result = voxels(c.mesh, grid);
    CHECK(result.repair.closed() == c.closed);
    const double wrong = grossly_wrong(result.values, want);
    CHECK(wrong <= 1e-3);  // required
    for (const float v : result.values) {
      if (!(v >= 0 && v <= 1)) FAIL("coverage ", v);
    }
  }
}

TEST_CASE("overlapping solids are one solid") {
  const TriangleSoup ball = vam::oracle::sphere(20, 60);
  const model::Grid grid = cube_grid(80);
  const std::vector<float> left = voxels(vam::oracle::join({}, ball, {-10, 0, 0}), grid).values;
  const std::vector<float> right = voxels(vam::oracle::join({}, ball, {10, 1, 0}), grid).values;
  std::vector<float> want(left.size());
  for (std::size_t i = 0; i < want.size(); ++i) want[i] = std::max(left[i], right[i]);
  const TriangleSoup both = vam::oracle::join(vam::oracle::join({}, ball, {-10, 0, 0}), ball, {10, 1, 0});
  CHECK(grossly_wrong(voxels(both, grid).values, want) <= 1e-3);
  // The same when one of the two is inside out, and when a small one lies within a large one.
  const TriangleSoup mixed =
      vam::oracle::join(vam::oracle::join({}, ball, {-10, 0, 0}), vam::oracle::flipped(ball, 1, 1), {10, 1, 0});
  CHECK(grossly_wrong(voxels(mixed, grid).values, want) <= 1e-3);
  const Result nested = voxels(vam::oracle::join(ball, vam::oracle::sphere(8, 20)), grid);
  CHECK(nested.values == voxels(ball, grid).values);
}

TEST_CASE("solids that share faces are covered once") {
  const model::Grid grid = cube_grid(16, 0.7);
  const Affine map{{Point{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0.11, 0.23, -0.17}};
  const auto block = [&](double from, double to) {
    TriangleSoup mesh = vam::oracle::box({from, -2, -3}, {to, 2, 3});
    transform(mesh, map);
    return mesh;
  };
  const std::vector<float> want = voxels(block(-4, 4), grid).values;
  const TriangleSoup whole = block(-4, 4);
  TriangleSoup mirrored = whole;  // the other diagonals
  for (Vector3& p : mirrored.points) p[1] = 2 * map.shift[1] - p[1];
  mirrored = vam::oracle::flipped(mirrored, 1, 1);
  const std::vector<TriangleSoup> pairs{
      vam::oracle::join(block(-4, 1), block(-1, 4)),        // four faces in common
      vam::oracle::join(block(-4, 0.01), block(-0.01, 4)),  // in a sheet that is thinner than a voxel
      vam::oracle::join(block(-4, 1), block(1, 4)),         // touching
      vam::oracle::join(whole, block(1, 4)),                // ending in the same triangles
      vam::oracle::join(whole, whole),
      vam::oracle::join(whole, mirrored),
      vam::oracle::join(vam::oracle::join(block(-4, 2), block(-2, 4)), block(-3, 3)),
  };
  for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
    CAPTURE(pair);
    const Result both = voxels(pairs[pair], grid);
    CHECK(both.repair.closed());
    for (std::size_t i = 0; i < want.size(); ++i)
      CHECK(double(std::abs(both.values[i] - want[i])) < 2e-6);  // the snapping to 0 and 1, and float
  }
}

TEST_CASE("the union of turned boxes that cross, against cutting cubes with half spaces") {
  Affine map = rotation({10, 20, 30});
  map.shift = {0.3, -0.2, 0.13};
  const auto along = [&](double way) { return Affine{map.linear, map({way, 0, 0})}; };
  const Turned a = turned_box({3, 2.25, 3}, map);
  const Turned moved = turned_box({3, 2.25, 3}, along(3));  // along itself: four faces in common
  const Turned turned = turned_box({3, 2.25, 3}, rotation({-25, 40, 15}));
  std::vector<vam::oracle::HalfSpace> crossing = a.planes;
  crossing.insert(crossing.end(), turned.planes.begin(), turned.planes.end());
  const model::Grid grid = cube_grid(20, 0.8);
  for (const auto& [b, shared] :
       {std::pair{moved, turned_box({1.5, 2.25, 3}, along(1.5)).planes}, std::pair{turned, crossing}}) {
    const Result both = voxels(vam::oracle::join(a.mesh, b.mesh), grid);
    double sum = 0;
    for (const auto [k, j, i] : indices(grid.nz, grid.ny, grid.nx)) {
      const auto of = [&](const std::vector<vam::oracle::HalfSpace>& planes) {
        return vam::oracle::shared_volume({grid.x_mm(i), grid.y_mm(j), grid.z_mm(k)}, grid.voxel_mm, planes) /
               std::pow(grid.voxel_mm, 3);
      };
      const double want = of(a.planes) + of(b.planes) - of(shared);
      const auto at = static_cast<std::size_t>((k * grid.ny + j) * grid.nx + i);
      CHECK(std::abs(both.values[at] - want) <
            0.002);  // rays pass at 16 x 16 places: edges between them are off by 1/16 squared at most
      sum += want;
    }
    CHECK(std::abs(both.sum() / sum - 1) < 1e-4);
  }
}

TEST_CASE("a closed cavity stays a void, however the file is turned") {
  const TriangleSoup outer = vam::oracle::sphere(30, 80);
  const TriangleSoup inner = vam::oracle::sphere(12, 40);
  const TriangleSoup part = vam::oracle::join(outer, vam::oracle::flipped(inner, 1, 1), {3, 4, 5});
  const model::Grid grid = cube_grid(64);
  const double volume = vam::oracle::signed_volume(outer) - vam::oracle::signed_volume(inner);
  for (const TriangleSoup& mesh :
       {part, vam::oracle::flipped(part, 1, 1), vam::oracle::flipped(part, 0.01, 2), vam::oracle::unwelded(part)}) {
    const Result result = voxels(mesh, grid);
    CHECK(result.repair.cavities == 1);
    CHECK(std::abs(result.sum() / volume - 1) < 1e-6);
    CHECK(result.values[(37 * 64 + 36) * 64 + 35] == 0);
  }
  // An island within the cavity is a solid again.
  const Result island = voxels(vam::oracle::join(part, vam::oracle::sphere(5, 20), {3, 4, 5}), grid);
  CHECK(island.repair.cavities == 1);
  CHECK(island.values[(37 * 64 + 36) * 64 + 35] == 1);
  // With a hole in the outer surface the cavity is still there.
  const TriangleSoup open =
      vam::oracle::join(vam::oracle::punched(outer, {30, 0, 0}, 2.4), vam::oracle::flipped(inner, 1, 1), {3, 4, 5});
  const std::vector<float> want = voxels(part, grid).values;
  CHECK(grossly_wrong(voxels(open, grid).values, want) <= 1e-3);
}

TEST_CASE("faces on voxel borders, and thin walls") {
  const model::Grid grid = cube_grid(16);
  // The box fills voxels exactly: borders at whole voxels, up to the edge of the grid.
  const Result block = voxels(vam::oracle::box({-8, -3, -8}, {2, 5, 8}), grid);
  for (std::size_t at = 0; at < block.values.size(); ++at) {
    const std::size_t i = at % 16;
    const std::size_t j = at / 16 % 16;
    const bool inside = i < 10 && j >= 5 && j < 13;
    if (block.values[at] != (inside ? 1.0F : 0.0F)) FAIL("voxel ", i, " ", j, " ", at / 256);
  }
  // A wall of a hundredth of a voxel is not lost.
  const Result wall = voxels(vam::oracle::box({-5, -5, 0.4}, {5, 5, 0.41}), grid);
  CHECK(wall.sum() == doctest::Approx(1.0).epsilon(1e-5));
}

TEST_CASE("what lies below or above the grid is cut off") {
  const TriangleSoup ball = vam::oracle::sphere(18.3, 40);
  const model::Grid whole = cube_grid(40);
  model::Grid middle = whole;
  middle.nz = 9;
  middle.origin_mm[2] += 17;  // 17 slices of one voxel up
  for (const Fill fill : {Fill::exact, Fill::vote}) {
    std::vector<float> want;
    std::vector<float> got;
    (void)voxelize(ball, whole, fill, Bounds{}, [&](int, int count, const float* slices) {
      want.insert(want.end(), slices, slices + static_cast<std::size_t>(count) * whole.slice_size());
    });
    (void)voxelize(ball, middle, fill, Bounds{}, [&](int, int count, const float* slices) {
      got.insert(got.end(), slices, slices + static_cast<std::size_t>(count) * middle.slice_size());
    });
    for (std::size_t i = 0; i < got.size(); ++i) {
      CHECK(static_cast<double>(std::abs(got[i] - want[i + 17 * whole.slice_size()])) <
            2e-6);  // float and the snapping to 0 and 1
    }
  }
}

TEST_CASE("a cup without its lid is full, an open sheet is empty") {
  const model::Grid grid = cube_grid(20);
  TriangleSoup cup = vam::oracle::box({-5, -5, -5}, {5, 5, 5});
  cup.triangles.erase(cup.triangles.begin() + 2, cup.triangles.begin() + 4);  // the face z = 5
  const Result full = voxels(cup, grid);
  CHECK(full.vote.undecided == 0);
  CHECK(full.sum() == doctest::Approx(1000));
  TriangleSoup sheet{{{-5, -5, 0.2}, {5, -5, 0.2}, {5, 5, 0.2}, {-5, 5, 0.2}}, {{0, 1, 2}, {0, 2, 3}}};
  CHECK(voxels(sheet, grid).sum() == 0);
}

TEST_CASE("the same bytes for any number of threads") {
  const TriangleSoup whole = vam::oracle::lumpy_sphere(20, 60, 0.1);
  const model::Grid grid = cube_grid(52);
  for (const TriangleSoup& mesh : {whole, vam::oracle::without(whole, 0.01, 3)}) {
    set_threads(1);
    const std::vector<float> one = voxels(mesh, grid).values;
    set_threads(0);
    CHECK(one == voxels(mesh, grid).values);
  }
}

TEST_CASE("an axis with a face on one side only counts half; more than half is undecided") {
  // A bar of 6 x 1 x 6 voxels, less than a voxel thick: both faces across x are missing, and the upper one across z.
  const model::Grid grid = cube_grid(12);
  for (const double thickness : {0.4, 0.45, 0.55, 0.8}) {
    TriangleSoup bar = vam::oracle::box({-3, 0.1, -3}, {3, 0.1 + thickness, 3});
    std::erase_if(bar.triangles, [&](const auto& t) {
      const auto all_at = [&](std::size_t axis, double mm) {
        return bar.points[t[0]][axis] == mm && bar.points[t[1]][axis] == mm && bar.points[t[2]][axis] == mm;
      };
      return all_at(0, -3) || all_at(0, 3) || all_at(2, 3);
    });
    REQUIRE(bar.triangles.size() == 6);
    const Result found = voxels(bar, grid);
    CAPTURE(thickness);
    CHECK(found.vote.undecided == (thickness > 0.5 ? 36 : 0));
    if (thickness < 0.5) CHECK(found.sum() == doctest::Approx(36 * 0.5 * thickness).epsilon(1e-5));
  }
}
