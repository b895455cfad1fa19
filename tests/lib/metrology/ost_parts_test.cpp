// SPDX-License-Identifier: GPL-3.0-or-later
// Refinement, volumes of a print that goes on, and whole parts through the camera: glass, resin, noise, 4 x 4 binning.
#include "lib/metrology/synthetic_views.hpp"
#include "metrology/ost/ost.hpp"
#include "metrology/ost/private/mlem.hpp"
#include "metrology/ost/sliding_turn.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "solid/voxel/isosurface.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

constexpr double raw_mm = 0.04;
constexpr int binning = 4;
constexpr double voxel_mm = raw_mm * binning;

// Distance to the solid's surface, to first order.
double off_surface_mm(const solid::Field& field, const Vector3& p) {
  constexpr double h = 1e-3;
  Vector3 gradient{};
  for (std::size_t d = 0; d < 3; ++d) {
    Vector3 up = p;
    Vector3 down = p;
    up[d] += h;
    down[d] -= h;
    gradient[d] = (field.value(up) - field.value(down)) / (2 * h);
  }
  return field.value(p) / std::max(length(gradient), 1e-9);
}

// Points of the solid's true surface: where random lines along an axis cross it.
std::vector<Vector3> true_surface(const solid::Field& field) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vector3> points;
  for (int line = 0; line < 1500; ++line) {
    const auto along = static_cast<std::size_t>(line % 3);
    Vector3 p{};
    for (std::size_t d = 0; d < 3; ++d) p[d] = field.box.low[d] + unit(random) * (field.box.high[d] - field.box.low[d]);
    constexpr double step = 0.02;
    p[along] = field.box.low[along] - step / 2;
    double before = field.value(p);
    while (p[along] < field.box.high[along] + step) {
      p[along] += step;
      const double now = field.value(p);
      if ((before < 0) != (now < 0)) {
        points.push_back(p);
        points.back()[along] -= step * now / (now - before);
      }
      before = now;
    }
  }
  return points;
}

struct Rms {
  double print_to_design_mm = 0;
  double design_to_print_mm = 0;
};

Rms surface_rms(const solid::Field& field, const model::TriangleSoup& print) {
  Rms rms;
  for (const auto& p : print.points) rms.print_to_design_mm += std::pow(off_surface_mm(field, p), 2);
  rms.print_to_design_mm = std::sqrt(rms.print_to_design_mm / static_cast<double>(print.points.size()));
  const solid::Surface surface(print);
  const auto points = true_surface(field);
  for (const auto& p : points) rms.design_to_print_mm += std::pow(surface.signed_distance(p), 2);
  rms.design_to_print_mm = std::sqrt(rms.design_to_print_mm / static_cast<double>(points.size()));
  return rms;
}

// The bars of [OST22]: a voxel, and 1 % of the size; and refraction must matter.
void judge(const std::string& shape, double size_mm, int columns, int rows) {
  const solid::Field field = solid::make_shape(shape);
  const model::Printer printer = test::glass_rig();
  const auto camera = test::camera_bench(printer, columns, rows, raw_mm);
  constexpr double noise = 0.2;  // of a raw pixel, 4 % or more of the brightest; a density of 1 fills about 5 mm
  const test::FineDensity density(field, 0.04);
  const auto views = test::take_views(camera, [&](double x, double y, double z) { return density(x, y, z); },
                                      test::even_angles(96), noise, binning, {0.15, field.radius_mm + 0.2});
  const AxisEstimate axis = find_axis(mean_view(views));
  const auto rms_of = [&](bool refraction) {
    OstOptions options{.refraction = refraction};
    const OstReconstructor rig(printer, voxel_mm, columns / binning, rows / binning, axis.pose, options);
    return surface_rms(field, solid::isosurface(rig.reconstruct(views), 0.5));
  };
  const Rms with = rms_of(true);
  const Rms without = rms_of(false);
  MESSAGE(shape, ": print to design ", with.print_to_design_mm, " mm, back ", with.design_to_print_mm,
          " mm; without refraction ", without.print_to_design_mm, " and ", without.design_to_print_mm, " mm");
  for (const double rms : {with.print_to_design_mm, with.design_to_print_mm}) {
    CHECK(rms <= voxel_mm);
    CHECK(rms <= 0.01 * size_mm);
  }
  CHECK(without.print_to_design_mm >= 3 * with.print_to_design_mm);
}

}  // namespace

TEST_CASE("a gyroid is reconstructed within a voxel and 1 % of its size") {
  judge("gyroid:cell=5,sheet=1,diameter=9,height=5", 9, 368, 144);
}

TEST_CASE("a boat is reconstructed within a voxel and 1 % of its size") {
  judge("boat:length=10,wall=0.8", 10, 424, 200);
}

TEST_CASE("struts three voxels apart are resolved with a contrast of 20 % at least") {
  // Upright bars of one and a half voxels, a pitch of three voxels, beside the axis where refraction has most to say.
  constexpr double pitch = 3 * voxel_mm;
  const model::Printer printer = test::glass_rig();
  const auto camera = test::camera_bench(printer, 256, 32, raw_mm);
  const auto bars = [](double x, double y, double) {
    if (std::abs(x - 1.7) > 3.5 * pitch || std::abs(y) > 0.5) return 0.0;
    const double at = (x - 1.7) / pitch;
    return std::abs(at - std::round(at)) < 0.25 ? 1.0 : 0.0;
  };
  const auto views = test::take_views(camera, bars, test::even_angles(120), 0.05, binning, {0.04, 4});
  const OstReconstructor rig(printer, voxel_mm, 64, 8, {0.5 * 63, 0}, {});
  const model::Volume volume = rig.reconstruct(views);
  const auto at = [&](double x) {
    const auto& g = volume.grid;
    const double column = (x - g.origin_mm[0]) / g.voxel_mm;
    const int i = static_cast<int>(column);
    double low = 0;
    double high = 0;
    for (int j = g.ny / 2 - 1; j <= g.ny / 2 + 1; ++j) {
      low += static_cast<double>(volume.slice(g.nz / 2)[j * g.nx + i]) / 3;
      high += static_cast<double>(volume.slice(g.nz / 2)[j * g.nx + i + 1]) / 3;
    }
    return low + (column - i) * (high - low);
  };
  double bright = 0;
  double dark = 0;
  for (int n = -2; n <= 2; ++n) bright += at(1.7 + n * pitch) / 5;
  for (int n = -2; n < 2; ++n) dark += at(1.7 + (n + 0.5) * pitch) / 4;
  const double contrast = (bright - dark) / (bright + dark);
  MESSAGE("contrast ", 100 * contrast, " %");
  CHECK(contrast >= 0.2);
}

TEST_CASE("the likelihood's maximum of exact sinograms is the image, and pixels that no ray meets stay empty") {
  tomo::ParallelGeometry geometry;
  geometry.nx = geometry.ny = 32;
  geometry.columns = 20;  // the corners are beyond all rays
  geometry.angles = 40;
  geometry.axis_x = geometry.axis_y = 15.5;
  geometry.angle_step_rad = 2 * std::numbers::pi / geometry.angles;
  std::vector<Slab> disc(1, Slab(32, 32));
  for (const auto [y, x] : indices(32, 32)) *disc[0].at(x, y) = std::hypot(x - 15.5, y - 15.5) < 6 ? 1.0F : 0.0F;
  std::vector<Slab> sinograms(1, Slab(geometry.columns, geometry.angles));
  tomo::forward(geometry, disc, sinograms);
  std::vector<Slab> images(1, Slab(32, 32));
  std::fill(images[0].values.begin(), images[0].values.end(), 0.5F);
  metrology::maximise_likelihood(geometry, sinograms, 60, images);
  CHECK(*images[0].at(0, 0) < 1e-6F);
  CHECK(*images[0].at(31, 31) < 1e-6F);
  CHECK(*images[0].at(15, 15) == doctest::Approx(1).epsilon(0.03));
  CHECK(*images[0].at(15, 24) < 0.05F);
  CHECK(std::all_of(images[0].values.begin(), images[0].values.end(), [](float v) { return v >= 0; }));
}

TEST_CASE("a volume is due after each full turn, of one turn's views") {
  SlidingTurn turn(360);
  int volumes = 0;
  for (int i = 0; i < 3 * 90 + 10; ++i) {
    if (!turn.push({{}, std::fmod(4.0 * i, 360.0), 50 + 0.1 * i})) continue;
    ++volumes;
    CHECK(turn.views().size() == 90);
    CHECK((i + 1) % 90 == 0);
    CHECK(turn.turns() == doctest::Approx(volumes));
    CHECK(turn.turn_s() == doctest::Approx(9));
  }
  CHECK(volumes == 3);
  CHECK(turn.turns() == doctest::Approx((280 * 4) / 360.0));
  CHECK(SlidingTurn(360).turn_s() == 0);
}

TEST_CASE("volumes more often than each turn, and in the opposite direction") {
  SlidingTurn turn(90);
  std::vector<int> due;
  for (int i = 0; i < 180; ++i) {
    if (turn.push({{}, -4.0 * i})) due.push_back(i);
  }
  CHECK(due == std::vector<int>{89, 112, 134, 157, 179});
  CHECK(turn.views().size() == 90);
}
