// SPDX-License-Identifier: GPL-3.0-or-later
// What repair finds and does, counted on meshes with known damage.
#include "solid/mesh/repair.hpp"

#include "oracle/meshes.hpp"
#include "oracle/polygon_soup.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::solid;
using model::TriangleSoup;

namespace {

const TriangleSoup cube = vam::oracle::box({-1, -1, -1}, {1, 1, 1});

Repair repaired(TriangleSoup& mesh) { return repair(mesh, "test"); }
Repair repaired_copy(TriangleSoup mesh) { return repair(mesh, "test"); }

}  // namespace

TEST_CASE("a sound mesh is not changed") {
  TriangleSoup mesh = cube;
  const Repair done = repaired(mesh);
  CHECK(done.closed());
  CHECK_FALSE(done.changed());
  CHECK(done.summary().empty());
  CHECK(done.components == 1);
  CHECK(mesh.triangles.size() == 12);
  CHECK(vam::oracle::signed_volume(mesh) == doctest::Approx(8));
}

TEST_CASE("equal points are welded, 0 and -0 too, and unused ones dropped") {
  TriangleSoup mesh = vam::oracle::unwelded(vam::oracle::box({0, 0, 0}, {1, 1, 1}));
  for (std::size_t i = 0; i < mesh.points.size(); i += 2) {
    for (double& c : mesh.points[i]) {
      if (c == 0) c = -0.0;
    }
  }
  mesh.points.push_back({7, 7, 7});
  const Repair done = repaired(mesh);
  CHECK(mesh.points.size() == 8);
  CHECK(done.points_welded == 36 - 8);
  CHECK(done.closed());
  CHECK_FALSE(done.changed());  // every STL file needs this; it is no repair to talk about
}

TEST_CASE("cracks are welded, features are not") {
  TriangleSoup mesh = vam::oracle::cracked(vam::oracle::sphere(10, 20), 1e-4, 1);
  const Repair done = repaired(mesh);
  CHECK(done.closed());
  CHECK(done.weld_distance > 2e-4);
  CHECK(done.weld_distance < 0.0035);  // 1e-4 of the diagonal
  CHECK(mesh.points.size() == vam::oracle::sphere(10, 20).points.size());
  // Two sheets a hair apart keep their points: nothing but borders is joined, at a fifth of their edges at most.
  TriangleSoup wall = vam::oracle::box({0, 0, 0}, {10, 10, 1e-4});
  CHECK(repaired(wall).weld_distance == 0);
  CHECK(wall.points.size() == 8);
}

TEST_CASE("a solid that fills a cavity of another leaves no cavity, whichever comes first") {
  const auto inwards = [](model::TriangleSoup mesh) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
    return mesh;
  };
  const model::TriangleSoup block = oracle::box({-3, -3, -3}, {3, 3, 3});
  const model::TriangleSoup core = oracle::sphere(2, 12);
  const model::TriangleSoup pocket = inwards(core);
  for (const auto& parts : {std::array{block, pocket, core}, {core, block, pocket}, {pocket, core, block}}) {
    model::TriangleSoup mesh = oracle::join(oracle::join(parts[0], parts[1]), parts[2]);
    const Repair done = repair(mesh, "test");
    CHECK(done.closed());
    CHECK(done.cavities == 0);
    CHECK(oracle::signed_volume(mesh) == doctest::Approx(216));
  }
  // A body of which each triangle is there both ways round stays.
  model::TriangleSoup twice = oracle::join(block, oracle::join(core, pocket), {8, 0, 0});
  repair(twice, "test");
  CHECK(oracle::signed_volume(twice) == doctest::Approx(216 + oracle::signed_volume(core)));
}

TEST_CASE("degenerate and duplicate triangles are removed") {
  TriangleSoup mesh = cube;
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({mesh.triangles[3][1], mesh.triangles[3][2], mesh.triangles[3][0]});  // a copy
  mesh.triangles.push_back({mesh.triangles[5][0], mesh.triangles[5][2], mesh.triangles[5][1]});  // a copy turned over
  const Repair done = repaired(mesh);
  CHECK(done.degenerate_dropped == 1);
  CHECK(done.duplicates_dropped == 2);
  CHECK(mesh.triangles.size() == 12);
  CHECK(done.closed());
  CHECK(vam::oracle::signed_volume(mesh) == doctest::Approx(8));
}

TEST_CASE("a wall of zero thickness between closed surfaces is removed, both sides of it") {
  // Two cubes side by side, each with its own face where they touch: the two copies cancel.
  TriangleSoup mesh = vam::oracle::join(cube, cube, {2, 0, 0});
  const Repair done = repaired(mesh);
  CHECK(done.closed());
  CHECK(done.duplicates_dropped == 4);
  CHECK(done.components == 1);
  CHECK(vam::oracle::signed_volume(mesh) == doctest::Approx(16));
}

TEST_CASE("a face in which two overlapping solids end is kept twice") {
  const TriangleSoup inner = vam::oracle::box({0, -1, -1}, {1, 1, 1});
  TriangleSoup mesh = vam::oracle::join(cube, inner);  // both end in x = 1, in the same triangles
  const Repair done = repaired(mesh);
  CHECK(done.closed());
  CHECK(done.duplicates_dropped == 0);
  CHECK(vam::oracle::signed_volume(mesh) == doctest::Approx(12));
  CHECK(done.shared.size()[0] > 0);
  // Copies of other triangles are no face in common.
  for (const auto& triangle : inner.triangles) {
    if (std::all_of(triangle.begin(), triangle.end(), [&](int corner) { return inner.points[corner][0] == 1; }))
      continue;
    TriangleSoup more = vam::oracle::join(cube, inner);
    more.triangles.push_back(triangle);
    for (int& corner : more.triangles.back()) corner += static_cast<int>(cube.points.size());
    CHECK(repaired(more).duplicates_dropped == 1);
  }
}

TEST_CASE("where solids may overlap") {
  const auto shared = [](const TriangleSoup& mesh) {
    TriangleSoup copy = mesh;
    return repaired(copy).shared;
  };
  const Bounds nowhere{};
  CHECK(shared(cube).low == nowhere.low);
  CHECK(shared(vam::oracle::join(cube, cube, {3, 0, 0})).low == nowhere.low);
  const Bounds both = shared(vam::oracle::join(cube, cube, {1.5, 0.5, 0}));
  CHECK(both.low == Vector3{0.5, -0.5, -1});
  CHECK(both.high == Vector3{1, 1, 1});
  const TriangleSoup cavity = vam::oracle::flipped(vam::oracle::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), 1, 1);
  CHECK(shared(vam::oracle::join(cube, cavity)).low == nowhere.low);
}

TEST_CASE("a surface in both orientations at once is kept once") {
  TriangleSoup mesh = vam::oracle::join(cube, vam::oracle::flipped(cube, 1, 1));
  const Repair done = repaired(mesh);
  CHECK(done.duplicates_dropped == 12);
  CHECK(vam::oracle::signed_volume(mesh) == doctest::Approx(8));
}

TEST_CASE("orientation: one triangle, all of them, and one of two solids") {
  for (const double share : {0.1, 1.0}) {
    TriangleSoup mesh = vam::oracle::flipped(vam::oracle::sphere(3, 20), share, 4);
    CHECK(repaired(mesh).closed());
    CHECK(vam::oracle::signed_volume(mesh) == doctest::Approx(vam::oracle::signed_volume(vam::oracle::sphere(3, 20))));
  }
  TriangleSoup two = vam::oracle::join(cube, vam::oracle::flipped(cube, 1, 1), {5, 0, 0});
  const Repair done = repaired(two);
  CHECK(done.flipped == 12);
  CHECK(done.components == 2);
  CHECK(done.cavities == 0);
  CHECK(vam::oracle::signed_volume(two) == doctest::Approx(16));
}

TEST_CASE("cavities and islands keep their orientation, in inverted files too") {
  const TriangleSoup large = vam::oracle::box({-3, -3, -3}, {3, 3, 3});
  const TriangleSoup island = vam::oracle::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  const TriangleSoup nest = vam::oracle::join(vam::oracle::join(large, vam::oracle::flipped(cube, 1, 1)), island);
  for (const double share : {0.0, 1.0}) {
    TriangleSoup mesh = vam::oracle::flipped(nest, share, 1);
    const Repair done = repaired(mesh);
    CHECK(done.cavities == 1);
    CHECK(vam::oracle::signed_volume(mesh) == doctest::Approx(216 - 8 + 1));
  }
  // The box of one holds that of the other, but not its body: a ring's middle is outside.
  TriangleSoup frame = vam::oracle::join(
      vam::oracle::join(vam::oracle::box({-3, 2, -3}, {3, 3, 3}), vam::oracle::box({-3, -3, -3}, {3, -2, 3})),
      vam::oracle::flipped(cube, 1, 1));
  CHECK(repaired(frame).cavities == 0);
}

TEST_CASE("boundary, non-manifold and unorientable edges are counted") {
  TriangleSoup lidless = cube;
  lidless.triangles.pop_back();
  const Repair open = repaired(lidless);
  CHECK(open.boundary_edges == 3);
  CHECK_FALSE(open.closed());
  CHECK(open.summary() == "3 boundary edges remain");

  // Two cubes that share one edge only: closed, though four triangles meet there.
  const Repair edge = repaired_copy(vam::oracle::join(cube, cube, {2, 2, 0}));
  CHECK(edge.non_manifold_edges == 1);
  CHECK(edge.closed());

  // A Moebius strip of five quadrilaterals.
  TriangleSoup strip;
  for (int i = 0; i < 5; ++i) {
    const double a = 1.2566370614359172 * i;
    for (const double side : {-0.4, 0.4}) {
      strip.points.push_back({(2 + side * std::cos(a / 2)) * std::cos(a), (2 + side * std::cos(a / 2)) * std::sin(a),
                              side * std::sin(a / 2)});
    }
  }
  for (int i = 0; i < 5; ++i) {
    const int p = 2 * i;
    const int q = i < 4 ? 2 * i + 2 : 1;  // the last joins the first upside down
    const int r = i < 4 ? 2 * i + 3 : 0;
    strip.triangles.push_back({p, q, p + 1});
    strip.triangles.push_back({p + 1, q, r});
  }
  CHECK(repaired(strip).unorientable == 1);
}

// CGAL chooses one of the two sides, this house the outer one: what both must agree on is which triangles run the same
// way, so the enclosed volume is the same up to its sign, whatever was flipped, split or doubled.
TEST_CASE("welded and oriented as CGAL's polygon soup does it") {
  const TriangleSoup sphere = vam::oracle::sphere(3, 20);
  for (const TriangleSoup& damaged :
       {vam::oracle::unwelded(sphere), vam::oracle::flipped(vam::oracle::unwelded(sphere), 0.2, 3),
        vam::oracle::flipped(sphere, 0.45, 7), vam::oracle::join(sphere, sphere),
        vam::oracle::unwelded(vam::oracle::flipped(cube, 0.3, 5))}) {
    TriangleSoup ours = damaged;
    const Repair done = repaired(ours);
    const TriangleSoup theirs = vam::oracle::oriented_by_cgal(damaged);
    CHECK(done.closed());
    CHECK(ours.points.size() == theirs.points.size());
    CHECK(ours.triangles.size() == theirs.triangles.size());
    CHECK(vam::oracle::signed_volume(ours) ==
          doctest::Approx(std::abs(vam::oracle::signed_volume(theirs))).epsilon(1e-12));
  }
}

TEST_CASE("a mesh without surface is an error") {
  TriangleSoup mesh{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}};
  CHECK(fault_of([&] { (void)repaired(mesh); }) == Fault::data);
}
