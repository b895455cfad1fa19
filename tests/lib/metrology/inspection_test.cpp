// SPDX-License-Identifier: GPL-3.0-or-later
// Faces, bores and walls whose form is known, and uncertainties against repeated prints.
#include "metrology/compare/inspection.hpp"

#include "base/text/json.hpp"
#include "lib/meshes.hpp"
#include "metrology/compare/datum.hpp"
#include "metrology/compare/trend.hpp"
#include "metrology/compare/uncertainty.hpp"
#include "solid/mesh/align.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

using Deform = std::function<Vector3(const Vector3&)>;

// A box [0, size] with faces of n x n squares, after `deform`.
model::TriangleSoup fine_box(const Vector3& size, int n, const Deform& deform) {
  model::TriangleSoup mesh;
  for (int face = 0; face < 6; ++face) {
    const auto across = static_cast<std::size_t>(face / 2);
    const std::size_t u = (across + 1) % 3;
    const std::size_t v = (across + 2) % 3;
    const int first = static_cast<int>(mesh.points.size());
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        Vector3 p{};
        p[across] = face % 2 == 1 ? size[across] : 0;
        p[u] = size[u] * i / n;
        p[v] = size[v] * j / n;
        mesh.points.push_back(deform(p));
      }
    }
    for (const auto [j, i] : indices(n, n)) {
      const int a = first + j * (n + 1) + i;
      const int b = a + n + 1;
      if (face % 2 == 1) {
        mesh.triangles.push_back({a, a + 1, b});
        mesh.triangles.push_back({a + 1, b + 1, b});
      } else {
        mesh.triangles.push_back({a, b, a + 1});
        mesh.triangles.push_back({a + 1, b, b + 1});
      }
    }
  }
  return mesh;
}

// An upright cylinder whose radius depends on angle and height.
model::TriangleSoup post(double height, const std::function<double(double, double)>& radius_of) {
  model::TriangleSoup mesh;
  constexpr int around = 180;
  constexpr int up = 40;
  for (int k = 0; k <= up; ++k) {
    for (int i = 0; i < around; ++i) {
      const double phi = 2 * std::numbers::pi * i / around;
      const double z = height * k / up;
      mesh.points.push_back({radius_of(phi, z) * std::cos(phi), radius_of(phi, z) * std::sin(phi), z});
    }
  }
  for (const auto [k, i] : indices(up, around)) {
    const int a = k * around + i;
    const int b = k * around + (i + 1) % around;
    mesh.triangles.push_back({a, b, a + around});
    mesh.triangles.push_back({b, b + around, a + around});
  }
  const int low = static_cast<int>(mesh.points.size());
  mesh.points.push_back({0, 0, 0});
  mesh.points.push_back({0, 0, height});
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({low, (i + 1) % around, i});
    mesh.triangles.push_back({low + 1, up * around + i, up * around + (i + 1) % around});
  }
  return mesh;
}

Json measured(const model::TriangleSoup& print, const model::TriangleSoup& design, const std::string& region) {
  const Inspection found = inspect(print, design, solid::Surface(design), 100000, {parse_region("it=" + region)});
  return figures_json(found)["regions"]["it"];
}

const Deform as_it_is = [](const Vector3& p) { return p; };

}  // namespace

TEST_CASE("the flatness, tilt and offset of a face that is a saddle") {
  const auto design = fine_box({10, 10, 4}, 40, as_it_is);
  // z = 0.002 (x - 5)(y - 5) + 0.03 + 0.01 (x - 5): the least-squares plane of a saddle is its middle; 4 corners of
  // 0.05 stand out in turn.
  const auto print = fine_box({10, 10, 4}, 40, [](const Vector3& p) -> Vector3 {
    const double top = p[2] / 4;
    return {p[0], p[1], p[2] + top * (0.002 * (p[0] - 5) * (p[1] - 5) + 0.03 + 0.01 * (p[0] - 5))};
  });
  const Json face = measured(print, design, "plane:-1,-1,3.5,11,11,4.5");
  // Samples come within 0.1 mm of the corners, 4 % of the saddle.
  CHECK(face["flatness_mm"].get<double>() == doctest::Approx(0.1).epsilon(0.04));
  CHECK(face["tilt_deg"].get<double>() == doctest::Approx(std::atan(0.01) * 180 / std::numbers::pi).epsilon(0.02));
  CHECK(face["offset_mm"].get<double>() == doctest::Approx(0.03).epsilon(0.03));
  CHECK(face["mean_mm"].get<double>() == doctest::Approx(0.03).epsilon(0.05));
}

TEST_CASE("the diameter and cylindricity of a bore that is oval") {
  const auto design = post(8, [](double, double) { return 3.0; });
  const auto print = post(8, [](double phi, double) { return 3.05 + 0.02 * std::cos(2 * phi); });
  const Json bore = measured(print, design, "cylinder:-4,-4,1,4,4,7");
  // 180 sides of a circle lie 3 (pi / 180)^2 / 2 = 0.0005 inside at most, a third of it on average, in both.
  CHECK(bore["diameter_mm"].get<double>() == doctest::Approx(6.1).epsilon(0.0002));
  CHECK(bore["design_diameter_mm"].get<double>() == doctest::Approx(6).epsilon(0.0002));
  CHECK(std::abs(bore["cylindricity_mm"].get<double>() - 0.04) < 0.001);
  CHECK(bore["tilt_deg"].get<double>() < 0.01);
  const auto cone = post(8, [](double, double z) { return 3 + 0.01 * (z - 4); });
  CHECK(std::abs(measured(cone, design, "cylinder:-4,-4,1,4,4,7")["cylindricity_mm"].get<double>() - 0.06) < 0.001);
}

TEST_CASE("the thickness of a wall that is not even") {
  const auto design = fine_box({10, 10, 1}, 40, as_it_is);
  const auto print = fine_box({10, 10, 1}, 40, [](const Vector3& p) -> Vector3 {
    return {p[0], p[1], p[2] > 0.5 ? p[2] + 0.02 * (p[0] - 5) / 5 : p[2] - 0.1};
  });
  const Json wall = measured(print, design, "wall:2,2,-1,8,8,2");
  CHECK(wall["design_thickness_mm"].get<double>() == doctest::Approx(1).epsilon(1e-6));
  CHECK(wall["thickness_mm"].get<double>() == doctest::Approx(1.1).epsilon(1e-3));
  CHECK(wall["min_thickness_mm"].get<double>() == doctest::Approx(1.1 - 0.02 * 3 / 5).epsilon(1e-3));
}

TEST_CASE("datum faces, not a bump elsewhere, decide the pose") {
  const auto design = fine_box({10, 8, 4}, 30, as_it_is);
  const double turn = 0.02;
  const auto moved = [&](const Vector3& p) -> Vector3 {
    const double z = p[2] > 3.99 && p[0] > 6 ? p[2] + 0.3 : p[2];  // on the top, which is no datum
    const Vector3 q{std::cos(turn) * p[0] - std::sin(turn) * p[1], std::sin(turn) * p[0] + std::cos(turn) * p[1], z};
    return {q[0] + 0.1, q[1] - 0.05, q[2] + 0.07};
  };
  model::TriangleSoup print = fine_box({10, 8, 4}, 30, moved);
  const solid::Surface surface(design);
  const std::vector<Region> regions{parse_region("a=plane:1,1,-1,9,7,1"), parse_region("b=plane:1,-1,1,9,1,3"),
                                    parse_region("c=plane:-1,1,1,1,7,3")};
  for (int round = 0; round < 3; ++round) {
    const Inspection seen = inspect(print, design, surface, 100000, regions);
    std::array<DatumFace, 3> faces;
    for (std::size_t f = 0; f < 3; ++f) {
      faces[f] = {print_plane(seen.regions[f], seen.distances), seen.regions[f].plane};
    }
    const solid::Similarity motion = datum_motion(faces);
    for (auto& point : print.points) point = motion(point);
  }
  // The corner where the three faces meet is back.
  CHECK(length(print.points[0]) < 1e-6);
  const Inspection seen = inspect(print, design, surface, 100000, regions);
  CHECK(figures_json(seen)["regions"]["a"]["max_mm"].get<double>() < 1e-6);
  CHECK(figures_json(seen)["hausdorff_mm"].get<double>() == doctest::Approx(0.3).epsilon(0.01));
  CHECK_THROWS_WITH_AS((void)datum_motion({DatumFace{{{}, {0, 0, 1}, 0}, {{}, {0, 0, 1}, 0}},
                                           DatumFace{{{}, {0, 0, -1}, 0}, {{}, {0, 0, -1}, 0}},
                                           DatumFace{{{}, {1, 0, 0}, 0}, {{}, {1, 0, 0}, 0}}}),
                       doctest::Contains("parallel"), Error);
}

TEST_CASE("uncertainties are those of repeated prints") {
  // The same print 16 times, its vertices moved by normal noise of 0.01 mm, aligned anew each time: the RMS departure
  // of each figure from the one without noise. Both sides are RMS of 16 to 20 draws, +-17 % each; extremes of noise
  // grow with more than its deviation, which the trials extrapolate linearly.
  constexpr double sigma_mm = 0.01;
  const auto design = fine_box({10, 8, 4}, 40, as_it_is);
  const auto true_print = fine_box({10, 8, 4}, 40, [](const Vector3& p) -> Vector3 {
    return {1.01 * p[0] - 0.05, 1.01 * p[1] - 0.04, p[2] + 0.01 * p[0] * p[2] / 4};
  });
  const solid::Surface surface(design);
  const std::vector<Region> regions{parse_region("top=plane:1,1,3.5,9,7,4.5"), parse_region("body=wall:1,1,-1,9,7,5")};
  const auto inspected = [&](model::TriangleSoup& print) {
    const auto pose = solid::refine(print, surface, {});
    for (auto& point : print.points) point = pose.transform(point);
    Inspection found = inspect(print, design, surface, 20000, regions);
    found.pose.aligned = true;
    return found;
  };
  model::TriangleSoup still = true_print;
  const Json truth = figures_json(inspected(still));
  const std::vector<std::string> names{"/print_to_design/mean_mm", "/print_to_design/rms_mm", "/hausdorff_mm",
                                       "/regions/top/flatness_mm", "/regions/body/thickness_mm"};
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, sigma_mm);
  std::vector<double> squares(names.size());
  std::vector<double> stated(names.size());
  double rough_mm = 0;
  constexpr int prints = 16;
  for (int n = 0; n < prints; ++n) {
    model::TriangleSoup print = true_print;
    for (auto& p : print.points) {
      for (double& x : p) x += normal(random);
    }
    const Inspection found = inspected(print);
    const Json figures = figures_json(found);
    SurfaceErrors errors = roughness(print, surface, 10);
    rough_mm += static_cast<double>(errors.vertex_mm.front()) / prints;
    const Json uncertainty = expanded_uncertainty(found, print, errors);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Json::json_pointer at(names[i]);
      squares[i] += std::pow(figures[at].get<double>() - truth[at].get<double>(), 2) / prints;
      stated[i] += uncertainty[at].get<double>() / 2 / prints;
    }
  }
  CHECK(rough_mm == doctest::Approx(sigma_mm).epsilon(0.1));
  for (std::size_t i = 0; i < names.size(); ++i) {
    CAPTURE(names[i]);
    const double ratio = stated[i] / std::sqrt(squares[i]);
    MESSAGE(names[i], ": departure ", std::sqrt(squares[i]), " mm, stated ", stated[i], ", ratio ", ratio);
    const bool extreme =
        names[i].find("hausdorff") != std::string::npos || names[i].find("flatness") != std::string::npos;
    CHECK(ratio > (extreme ? 0.5 : 0.65));
    CHECK(ratio < 1.6);
  }
}

TEST_CASE("an uncertain isovalue and the resolution move the mean, an uncertain scale the size") {
  const auto design = test::sphere({0, 0, 0}, 5, 60);
  const Inspection found = inspect(design, design, solid::Surface(design), 20000, {});
  const auto stated = [&](double common_mm, double scale, double resolution_mm = 0) {
    SurfaceErrors errors{"volume", std::vector<float>(design.points.size(), 0.0F), 0.2, common_mm, scale};
    errors.resolution_mm = resolution_mm;
    return expanded_uncertainty(found, design, errors)["print_to_design"]["mean_mm"].get<double>();
  };
  CHECK(stated(0, 0) < 1e-4);  // exact but for float
  // Two standard deviations, drawn 20 times: +-16 %.
  CHECK(stated(0.02, 0) == doctest::Approx(0.04).epsilon(0.4));
  CHECK(stated(0, 0, 0.02) == doctest::Approx(0.04).epsilon(0.4));
  CHECK(stated(0, 0.01) == doctest::Approx(2 * 0.01 * 5).epsilon(0.4));
}

TEST_CASE("what single places err is in the uncertainty of extremes, and of no others") {
  const auto design = test::sphere({0, 0, 0}, 5, 60);
  const Inspection found = inspect(design, design, solid::Surface(design), 20000, {});
  SurfaceErrors errors{"volume", std::vector<float>(design.points.size(), 0.0F), 0.2, 0, 0};
  errors.extreme_mm = 0.05;
  const Json stated = expanded_uncertainty(found, design, errors);
  CHECK(stated["print_to_design"]["max_mm"].get<double>() == doctest::Approx(0.1).epsilon(0.01));
  CHECK(stated["hausdorff_mm"].get<double>() == doctest::Approx(0.1).epsilon(0.01));
  CHECK(stated["hausdorff_percent"].get<double>() == doctest::Approx(100 * 0.1 / 10).epsilon(0.01));
  CHECK(stated["print_to_design"]["rms_mm"].get<double>() < 1e-4);
}

TEST_CASE("regions that cannot be measured are refused") {
  CHECK_THROWS_WITH_AS((void)parse_region("plane:0,0,0,1,1,1"), doctest::Contains("must begin with a name"), Error);
  CHECK_THROWS_WITH_AS((void)parse_region("a=cone:0,0,0,1,1,1"), doctest::Contains("not one of surface"), Error);
  CHECK_THROWS_WITH_AS((void)parse_region("a=0,0,0,1,1"), doctest::Contains("have 6"), Error);
  CHECK_THROWS_WITH_AS((void)parse_region("a=0,0,x,1,1,1"), doctest::Contains("'x' is not a number"), Error);
  const auto design = fine_box({10, 8, 4}, 10, as_it_is);
  CHECK_THROWS_WITH_AS((void)measured(design, design, "plane:20,20,20,21,21,21"), doctest::Contains("enlarge its box"),
                       Error);
}

TEST_CASE("the drift of repeated prints is a line's slope") {
  // Anscombe's first quartet in the order of x = 4 ... 14 [Am. Stat. 27, 1973]: slope 0.5001, standard error 0.1179,
  // t = 4.241 with 9 degrees of freedom, p = 0.00217; mean 7.501, standard deviation 2.032.
  const std::vector<double> y{4.26, 5.68, 7.24, 4.82, 6.95, 8.81, 8.04, 8.33, 10.84, 7.58, 9.96};
  const Trend found = trend_of(y, std::vector<double>(y.size(), 0.3));
  CHECK(found.prints == 11);
  CHECK(found.mean == doctest::Approx(7.501).epsilon(1e-4));
  CHECK(found.spread == doctest::Approx(2.032).epsilon(1e-3));
  CHECK(found.drift == doctest::Approx(0.5001).epsilon(1e-3));
  CHECK(found.drift_sigma == doctest::Approx(0.1179).epsilon(1e-3));
  CHECK(found.p == doctest::Approx(0.00217).epsilon(0.01));
  CHECK(found.last == 9.96);
  CHECK(found.uncertainty == doctest::Approx(0.3));
}
