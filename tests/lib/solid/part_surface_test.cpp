// SPDX-License-Identifier: GPL-3.0-or-later
// Thin walls, gaps and pieces of meshes against those that they were made with.
#include "solid/mesh/part_surface.hpp"

#include "oracle/meshes.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::solid;

namespace {

using Mesh = model::TriangleSoup;

/// Turned about two axes, so that nothing lies along the axes.
Mesh turned(Mesh mesh) {
  const double c = std::cos(0.5);
  const double s = std::sin(0.5);
  for (auto& p : mesh.points) {
    p = {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
    p = {p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]};
  }
  return mesh;
}

/// By voxels of which one has its centre there.
model::VoxelisedSurface seen(Mesh mesh, double voxel_mm = 1, const std::array<double, 3>& centre_mm = {}) {
  const Repair repaired = repair(mesh, "test");
  model::Grid grid = model::centred_grid(1, 1, 1, voxel_mm);
  grid.origin_mm = centre_mm;
  return {part_surface(mesh, repaired, grid), voxel_mm};
}

/// A round block along z of radius 8 and height 12, with a bore around its axis.
Mesh bored(double wide) {
  Mesh mesh;
  constexpr int facets = 64;
  const double to_facet = 1 / std::cos(std::numbers::pi / facets);
  for (const double radius : {8.0, 0.5 * wide * to_facet}) {
    for (const double z : {-6.0, 6.0}) {
      for (int n = 0; n < facets; ++n) {
        const double angle = 2 * std::numbers::pi * n / facets;
        mesh.points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
      }
    }
  }
  const auto quads = [&](int low, int high) {  // rings of points
    for (int n = 0; n < facets; ++n) {
      const int a = low * facets + n;
      const int b = low * facets + (n + 1) % facets;
      const int up = (high - low) * facets;
      mesh.triangles.push_back({a, b, b + up});
      mesh.triangles.push_back({a, b + up, a + up});
    }
  };
  quads(0, 1);
  quads(1, 3);
  quads(3, 2);
  quads(2, 0);
  return mesh;
}

/// A prism along y of that length; `inside` sees all corners of its outline in x and z.
Mesh prism(const std::vector<std::array<double, 2>>& outline, double length, const std::array<double, 2>& inside) {
  Mesh mesh;
  const int corners = static_cast<int>(outline.size());
  for (const double y : {0.0, length})
    for (const auto& [x, z] : outline) mesh.points.push_back({x, y, z});
  for (const double y : {0.0, length}) mesh.points.push_back({inside[0], y, inside[1]});
  for (int a = 0; a < corners; ++a) {
    const int b = (a + 1) % corners;
    mesh.triangles.push_back({a, b, 2 * corners});
    mesh.triangles.push_back({b + corners, a + corners, 2 * corners + 1});
    mesh.triangles.push_back({b, a, a + corners});
    mesh.triangles.push_back({b, a + corners, b + corners});
  }
  return mesh;
}

/// A tooth every `pitch` along x, of that height, on a block.
Mesh toothed(int teeth, double pitch, double height) {
  const double length = teeth * pitch;
  std::vector<std::array<double, 2>> outline{{0, -10}, {length, -10}};
  for (int n = teeth; n-- > 0;) {
    outline.push_back({(n + 1) * pitch, 0});
    outline.push_back({(n + 0.5) * pitch, height});
  }
  outline.push_back({0, 0});
  return prism(outline, 20, {0.5 * length, -5});
}

/// A roof of that angle, 20 high.
Mesh wedge(double angle_deg) {
  const double half = 20 * std::tan(0.5 * angle_deg * std::numbers::pi / 180);
  return {{{-half, 0, 0}, {half, 0, 0}, {0, 0, 20}, {-half, 30, 0}, {half, 30, 0}, {0, 30, 20}},
          {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {0, 2, 5}, {0, 5, 3}}};
}

}  // namespace

TEST_CASE("a plate is a thin wall below one and a half voxels, with its thickness, its faces and a place in it") {
  const Mesh block = oracle::box({-10, -10, -10}, {10, 10, 0});
  for (const double thick : {0.1, 0.6, 1.0, 1.4}) {
    CAPTURE(thick);
    const Mesh plate = oracle::box({-10, -10, 5}, {10, 10, 5 + thick});
    const auto thin = seen(turned(oracle::join(block, plate)));
    CHECK(thin.has_thin_walls());
    CHECK(thin.places.walls.mm == doctest::Approx(thick));
    CHECK(thin.places.walls.area_mm2 == doctest::Approx(800).epsilon(0.1));  // 1/sqrt(2400) of samples, 3 times
    CHECK(!thin.has_thin_gaps());
    CHECK(!thin.has_relief());
  }
  for (const auto& [thick, narrow] : {std::pair{1.6, true}, {1.95, true}, {2.05, false}}) {
    const auto judged = seen(turned(oracle::box({-10, -10, 5}, {10, 10, 5 + thick})));
    CHECK(!judged.leaves_doubt());
    CHECK(judged.places.walls.are_below(model::narrow_voxels, 1) == narrow);
    CHECK(judged.may_lose_walls());
  }
  const auto level = seen(oracle::join(block, oracle::box({-10, -10, 5}, {10, 10, 5.5})));
  CHECK(level.places.walls.at_mm[2] == doctest::Approx(5.25));
}

TEST_CASE("a slit is a gap below one and a half voxels; the side counts in voxels") {
  const auto slit = [](double wide) {
    return turned(oracle::join(oracle::box({-10, -10, -5}, {0, 10, 5}), oracle::box({wide, -10, -5}, {10, 10, 5})));
  };
  for (const double wide : {0.1, 0.6, 1.4}) {
    const auto thin = seen(slit(wide));
    CHECK(thin.has_thin_gaps());
    CHECK(thin.places.gaps.mm == doctest::Approx(wide));
    CHECK(thin.places.gaps.area_mm2 == doctest::Approx(400).epsilon(0.15));
    CHECK(!thin.has_thin_walls());
  }
  CHECK(!seen(slit(2)).leaves_doubt());
  CHECK(seen(slit(2)).places.gaps.mm == doctest::Approx(2));
  CHECK(!seen(slit(2.4)).may_lose_gaps());
  CHECK(seen(slit(1.6), 2).has_thin_gaps());
  CHECK(!seen(slit(0.6), 0.3).leaves_doubt());
}

TEST_CASE("a bore is a gap where no voxel is wholly within it, up to the diagonals of two voxels' faces") {
  for (const double wide : {1.6, 2.0, 2.75}) {
    CAPTURE(wide);
    const auto between = seen(bored(wide), 1, {0.5, 0.5, 0});  // four voxels share it
    CHECK(between.has_thin_gaps());
    CHECK(between.thin_gaps().mm == doctest::Approx(wide).epsilon(0.01));
    CHECK(between.thin_gaps().area_mm2 == doctest::Approx(12 * std::numbers::pi * wide).epsilon(0.15));
    CHECK(!between.has_thin_walls());
    CHECK(!seen(bored(wide)).leaves_doubt());  // one lies in its middle
  }
  CHECK(seen(bored(1.3)).has_thin_gaps());
  CHECK(!seen(bored(2.9), 1, {0.5, 0.5, 0}).leaves_doubt());
  CHECK(seen(bored(2.9), 2, {1, 1, 0}).has_thin_gaps());
  // A square slot of 1.8 voxels between two rows of them, and along one.
  const Mesh slot = oracle::join(oracle::box({-9, -9, -9}, {-0.9, 9, 9}), oracle::box({0.9, -9, -9}, {9, 9, 9}));
  CHECK(seen(slot, 1, {0.5, 0, 0}).has_thin_gaps());
  CHECK(!seen(slot).leaves_doubt());
}

TEST_CASE("balls that nearly touch have a gap, those farther apart none, and a ball has no wall") {
  const auto pair = [](double gap) {
    const Mesh ball = oracle::sphere(11.5, 60);
    return turned(oracle::join(ball, ball, {23 + gap, 0, 0}));
  };
  for (const double gap : {0.3, 0.5, 0.7}) {
    const auto thin = seen(pair(gap));
    CHECK(thin.has_thin_gaps());
    CHECK(thin.places.gaps.mm >= gap);
    CHECK(thin.places.gaps.mm < gap + 0.4);  // a tenth of a cap whose edge is 1.5 apart
    CHECK(!thin.has_thin_walls());
  }
  CHECK(!seen(pair(2)).leaves_doubt());
  CHECK(!seen(oracle::sphere(11.5, 60)).leaves_doubt());
}

TEST_CASE("faces of solids within each other are neither walls nor gaps") {
  const Mesh block = oracle::box({-10, -10, -10}, {10, 10, 0});
  // A plate on a block, of the block's own width, sunk by 0.4 and glued on.
  CHECK(!seen(turned(oracle::join(block, oracle::box({-10, -10, -0.4}, {10, 10, 0.8})))).has_thin_walls());
  CHECK(!seen(turned(oracle::join(block, oracle::box({-8, -8, -1}, {8, 8, -0.2})))).leaves_doubt());
  CHECK(!seen(turned(oracle::join(block, oracle::box({-8, -8, 0}, {8, 8, 1})))).has_thin_walls());
  CHECK(!seen(turned(oracle::join(block, block, {15, 0.3, 0.5}))).leaves_doubt());
}

TEST_CASE("solids that cross, touch or hold each other are one, and cavities none") {
  const auto solids = [](const Mesh& mesh) { return seen(turned(mesh)).places.solids; };
  const Mesh block = oracle::box({-10, -10, -10}, {10, 10, 0});
  const Mesh ball = oracle::sphere(3, 24);
  CHECK(solids(block) == 1);
  CHECK(solids(oracle::join(block, block, {15, 0.3, 0.5})) == 1);  // cross
  CHECK(solids(oracle::join(block, block, {20, 3, 1})) == 1);      // share a part of a face
  CHECK(solids(oracle::join(block, block, {20.01, 3, 1})) == 1);   // all but
  CHECK(solids(oracle::join(block, block, {20.1, 3, 1})) == 2);
  CHECK(solids(oracle::join(block, ball, {0, 0, -5})) == 1);  // within
  const Mesh blocks = oracle::join(block, block, {0, 0, 15});
  CHECK(solids(blocks) == 2);
  for (const double up : {1.0, -1.0}) {  // a post through one triangle of each, whose edges meet one block first
    Mesh post = oracle::box({-1, -1, -4.5}, {1, 1, 4.5});
    if (up < 0)
      for (auto& p : post.points) p = {p[0], -p[1], -p[2]};
    CHECK(solids(oracle::join(blocks, post, {4, -4, 2.5})) == 1);
    CHECK(solids(oracle::join(blocks, post, {-4, 4, 2.5})) == 1);
  }
  Mesh plates = oracle::box({-2, -2, -1}, {2, 2, 80});  // a bar through plates, each held by a small ring of contact
  for (int n = 0; n < 20; ++n) plates = oracle::join(plates, oracle::box({-50, -50, 0}, {50, 50, 2}), {0, 0, 4.0 * n});
  CHECK(solids(plates) == 1);
  CHECK(solids(oracle::join(ball, ball, {6.3, 0, 0})) == 2);
  CHECK(solids(oracle::join(oracle::join(ball, ball, {4, 0, 0}), ball, {8, 0, 0})) == 1);  // a chain
  Mesh hollow = oracle::sphere(4, 24);
  for (auto& triangle : hollow.triangles) std::swap(triangle[0], triangle[1]);
  const Mesh shell = oracle::join(oracle::sphere(8, 24), hollow);
  CHECK(solids(shell) == 1);
  CHECK(solids(oracle::join(shell, oracle::sphere(2, 24))) == 2);  // loose in the cavity
  CHECK(solids(oracle::join(shell, block, {0, 0, -20})) == 2);
  CHECK(solids(oracle::join(block, oracle::box({-10.0001, -10.0001, -10.0001}, {10.0001, 10.0001, 0.0001}))) ==
        1);                                                                                       // coat
  const auto speck = seen(turned(oracle::join(block, oracle::sphere(1, 24), {0, 0, 5}))).places;  // 4 voxels
  CHECK(speck.solids == 2);
  CHECK(speck.specks == 1);
  CHECK(seen(turned(oracle::join(block, oracle::sphere(2, 24), {0, 0, 5}))).places.specks == 0);
  Mesh open = oracle::join(block, block, {30, 0, 0});
  open.triangles.pop_back();
  CHECK(solids(open) == 0);
}

TEST_CASE("where solids touch or cross at an angle there is no gap, and within them no relief") {
  const Mesh plate = oracle::box({-10, -10, -4}, {10, 10, 0});
  for (const double radius : {5.0, 10.0, 20.0}) {
    const auto thin = seen(turned(oracle::join(plate, oracle::sphere(radius, 60), {0, 0, radius - 0.3})));
    CHECK(!thin.leaves_doubt());
    CHECK(!thin.may_lose_gaps());
  }
  Mesh bar = oracle::box({-20, -2.7, -2.7}, {20, 2.7, 2.7});
  Mesh crossing = bar;
  for (auto& p : crossing.points) p = {0.5 * p[0] - 0.866 * p[1], 0.866 * p[0] + 0.5 * p[1], p[2] + 0.2};
  CHECK(!seen(turned(oracle::join(bar, crossing))).leaves_doubt());
}

TEST_CASE("the edge of a wedge is no wall, that of a blade is") {
  CHECK(!seen(turned(wedge(60))).leaves_doubt());
  CHECK(!seen(turned(wedge(35))).leaves_doubt());
  CHECK(seen(turned(wedge(10))).has_thin_walls());
}

TEST_CASE("a nib along an edge is no wall, however parallel its faces; a fin is") {
  const auto ridge = [](double high) {  // a roof of 60 degrees, cut off where it is 0.1 wide, with a nib on top
    const double foot = 6;
    const double top = (foot - 0.05) * std::sqrt(3.0);
    return seen(turned(prism(
        {{-foot, 0}, {foot, 0}, {0.05, top}, {0.05, top + high}, {-0.05, top + high}, {-0.05, top}}, 16, {0, 4})));
  };
  CHECK(!ridge(0.2).leaves_doubt());
  CHECK(ridge(3).has_thin_walls());
}

TEST_CASE("a knurl is relief where its teeth are no larger than voxels") {
  const auto fine = seen(turned(toothed(20, 1.5, 1)));
  CHECK(fine.has_relief());
  CHECK(fine.places.relief.mm < 1.5);
  CHECK(!seen(turned(toothed(20, 1.5, 1)), 0.2).has_relief());
  CHECK(!seen(turned(toothed(4, 8, 5))).has_relief());
  CHECK(!seen(turned(toothed(20, 1.5, 0.1))).has_relief());  // a face that is all but smooth
}

TEST_CASE("of an open mesh the surface is taken as it is") {
  const Mesh plate = oracle::box({-10, -10, 5}, {10, 10, 6});
  Mesh open = plate;
  open.triangles.pop_back();
  CHECK(seen(turned(oracle::join(oracle::box({-10, -10, -10}, {10, 10, 0}), open))).has_thin_walls());
  CHECK(part_surface({}, {}, model::centred_grid(1, 1, 1, 1)).walls.area_mm2 == 0);
}
