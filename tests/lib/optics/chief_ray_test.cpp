// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/chief_ray.hpp"

#include "base/constants.hpp"
#include "lib/optics/view_bench.hpp"
#include "optics/skew_ray.hpp"
#include "optics/writable_radius.hpp"
#include "oracle/ray_tracer.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optics;

namespace {

// [RAY21]'s bench in projector pixels: one shell of n = 1.53, R = 212.37, D = 1.8 * 1024.
View ray21() { return {1843.2, 1.0, 0.0, {{212.37, 1.53}}}; }

View random_view(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto chance = [&](double p) { return std::bernoulli_distribution(p)(random); };
  View view;
  const double radius = between(5, 30);
  if (chance(0.8)) view.lens_mm = between(3, 20) * radius;
  if (chance(0.5)) {
    view.bath_index = between(1.3, 1.55);
    view.window_mm = between(1.0, 2.5) * radius;
  }
  double r = radius;
  for (int k = std::uniform_int_distribution<int>(1, 4)(random); k > 0; --k) {
    view.shells.push_back({r, between(1.3, 1.6)});
    r *= between(0.85, 0.99);
  }
  return view;
}

}  // namespace

TEST_CASE("chief rays have the check values") {
  struct Row {
    double x_p, x_v, delta_deg, transmittance, jacobian;
  };
  for (const Row& row : {Row{50, 32.6677, 3.2099, 0.95606, 0.65287}, Row{150, 97.7162, 12.7003, 0.94584, 0.64716},
                         Row{200, 129.9562, 25.5100, 0.83056, 0.64222}}) {
    const ChiefRay ray = chief_ray(ray21(), row.x_p);
    CHECK(ray.hits);
    // half a unit of the last digit printed in the table
    CHECK(std::abs(ray.x_v_mm - row.x_v) < 5e-5);
    CHECK(std::abs(ray.delta_rad * deg_per_rad - row.delta_deg) < 5e-5);
    CHECK(std::abs(ray.transmittance - row.transmittance) < 5e-6);
    CHECK(std::abs(ray.jacobian - row.jacobian) < 5e-6);
  }
}

TEST_CASE("chief rays agree with a vector ray tracer for random lenses, baths and shells") {
  std::mt19937 random(7);
  int compared = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const View view = random_view(random);
    const double radius = view.shells.front().radius_mm;
    // Up to 98 % of the reach: at the very edge the tracer itself divides by a vanishing cosine.
    const auto edge = column_of(view, 0.98 * reach_mm(view));
    REQUIRE(edge.has_value());
    const double x_p = std::uniform_real_distribution<double>(-edge->x_p_mm, edge->x_p_mm)(random);
    const auto truth = vam::oracle::trace(bench_of(view), x_p);
    const ChiefRay ray = chief_ray(view, x_p);
    REQUIRE(truth.has_value());
    REQUIRE(ray.hits);
    const vam::oracle::Line line = vam::oracle::line_of(*truth);
    CHECK(std::abs(ray.x_v_mm - static_cast<double>(line.t)) < 1e-9 * radius);
    CHECK(std::abs(ray.delta_rad - static_cast<double>(line.a)) < 1e-9);
    CHECK(std::abs(ray.transmittance - static_cast<double>(truth->transmittance)) < 1e-9);

    // Derivatives: central differences of the tracer, one Richardson step: error h^4 f5 ~ 1e-10, rounding 1e-19 / h.
    const auto slope = [&](vam::oracle::Real h, auto part) {
      const auto right = vam::oracle::line_of(*vam::oracle::trace(bench_of(view), x_p + h));
      const auto left = vam::oracle::line_of(*vam::oracle::trace(bench_of(view), x_p - h));
      return (part(right) - part(left)) / (2 * h);
    };
    const vam::oracle::Real h = 1e-4L * static_cast<vam::oracle::Real>(radius);
    const auto richardson = [&](auto part) {
      return static_cast<double>((4 * slope(h / 2, part) - slope(h, part)) / 3);
    };
    CHECK(std::abs(ray.jacobian - richardson([](const vam::oracle::Line& l) { return l.t; })) < 1e-9);
    CHECK(std::abs(ray.delta_rate - richardson([](const vam::oracle::Line& l) { return l.a; })) * radius < 1e-9);
    ++compared;
  }
  CHECK(compared == 2000);
}

TEST_CASE("the tracer and the closed form agree on which rays miss") {
  const View view = ray21();
  const double edge = 213.794;  // the tangent column [physics §12]
  CHECK(chief_ray(view, edge - 0.01).hits);
  CHECK(vam::oracle::trace(bench_of(view), edge - 0.01).has_value());
  CHECK_FALSE(chief_ray(view, edge + 0.01).hits);
  CHECK_FALSE(vam::oracle::trace(bench_of(view), edge + 0.01).has_value());
}

TEST_CASE("column_of inverts chief_ray") {
  std::mt19937 random(11);
  for (int trial = 0; trial < 1000; ++trial) {
    const View view = random_view(random);
    const double x_v = std::uniform_real_distribution<double>(-0.999, 0.999)(random) * reach_mm(view);
    const auto found = column_of(view, x_v);
    REQUIRE(found.has_value());
    const ChiefRay ray = chief_ray(view, found->x_p_mm);
    CHECK(std::abs(ray.x_v_mm - x_v) < 1e-12 * view.shells.front().radius_mm);
    CHECK(std::abs(found->ray.x_v_mm - x_v) < 1e-12 * view.shells.front().radius_mm);
    CHECK(found->ray.delta_rad == doctest::Approx(ray.delta_rad).epsilon(1e-9));
    CHECK(found->ray.transmittance == doctest::Approx(ray.transmittance).epsilon(1e-9));
  }
  CHECK_FALSE(column_of(ray21(), 1.001 * reach_mm(ray21())).has_value());
}

TEST_CASE("the tangent column gives the radius of the vial") {
  CHECK(std::abs(impact_mm(ray21(), 213.794) - 212.37) < 5e-4);  // digits [physics §12]
}

TEST_CASE("matched glass, resin and bath leave a telecentric beam alone") {
  View view{std::nullopt, 1.53, 20, {{12.7, 1.53}, {11.7, 1.53}}};
  const ChiefRay ray = chief_ray(view, 5);
  CHECK(ray.x_v_mm == doctest::Approx(5).epsilon(1e-14));
  CHECK(ray.delta_rad == 0);
  CHECK(ray.jacobian == doctest::Approx(1).epsilon(1e-14));
  CHECK(reach_mm(view) == 11.7);
}

TEST_CASE("a wall does not narrow the reach: n b is conserved from the outer surface on") {
  const View view{1843.2, 1.0, 0.0, {{212.37, 1.47}, {195, 1.53}}};
  CHECK(reach_mm(view) == doctest::Approx(212.37 / 1.53));
}

TEST_CASE("views are built from the printer") {
  model::Printer printer;
  const View plain = projector_view(printer);
  CHECK(*plain.lens_mm == doctest::Approx(1.8 * 1024 * 0.065));
  CHECK(plain.shells.size() == 1);
  printer.vial.wall_mm = 1;
  printer.vial.index_glass = 1.47;
  printer.camera.index_resin = 1.5;
  const View camera = camera_view(printer);
  CHECK(*camera.lens_mm == 200);
  REQUIRE(camera.shells.size() == 2);
  CHECK(camera.shells[0].index == 1.47);
  CHECK(camera.shells[1].radius_mm == doctest::Approx(11.7));
  CHECK(camera.shells[1].index == 1.5);
}

TEST_CASE("a projector may be telecentric in one direction only") {
  model::Printer printer;
  printer.projector.telecentric_columns = true;
  CHECK(!projector_view(printer).lens_mm);
  CHECK(*projector_view(printer).rows_lens_mm == doctest::Approx(1.8 * 1024 * 0.065));
  printer.projector.telecentric_columns = false;
  printer.projector.telecentric_rows = true;
  CHECK(projector_view(printer).lens_mm);
  CHECK(!projector_view(printer).rows_lens_mm);
}

TEST_CASE("impossible geometries are refused") {
  model::Printer printer;
  printer.vial.wall_mm = 12.7;
  CHECK_THROWS_AS(static_cast<void>(projector_view(printer)), Error);
  printer = {};
  printer.projector.lens_distance_mm = 10;
  CHECK_THROWS_AS(static_cast<void>(projector_view(printer)), Error);
  printer = {};
  printer.bath.index = 1.5;  // where is its window?
  CHECK_THROWS_AS(static_cast<void>(projector_view(printer)), Error);
  printer.projector.telecentric = true;  // then it does not matter
  CHECK_NOTHROW(static_cast<void>(projector_view(printer)));
  printer.projector.telecentric = false;
  printer.projector.telecentric_columns = true;  // its rows diverge in front of the window
  CHECK_THROWS_AS(static_cast<void>(projector_view(printer)), Error);
}

TEST_CASE("a vial that is displaced by the rate takes its ray to another column") {
  std::mt19937 random(5);
  for (int run = 0; run < 200; ++run) {
    const View view = random_view(random);
    const double moved_mm = 1e-4 * view.shells.front().radius_mm;
    const double x_p_mm = std::uniform_real_distribution<double>(-0.9, 0.9)(random) * edge_column(view).x_p_mm;
    const Displacement vial{.x_mm = moved_mm * displacement_rate(view, x_p_mm)};
    const double offset_mm = skew_ray(view, x_p_mm + moved_mm, 0, vial).offset_mm;
    CHECK(std::abs(offset_mm - chief_ray(view, x_p_mm).x_v_mm) < 1e-3 * moved_mm);
  }
}

TEST_CASE("the window of a bath is between the vial and the lens") {
  model::Printer printer{.projector = {.lens_distance_mm = 60}, .bath = {.index = 1.5}};
  const auto stands = [&](double window_mm) {
    printer.bath.window_mm = window_mm;
    return !fault_of([&] { (void)projector_view(printer); });
  };
  CHECK(stands(printer.vial.radius_mm));  // a vial that touches it
  CHECK_FALSE(stands(std::nextafter(printer.vial.radius_mm, 0)));
  CHECK(stands(std::nextafter(60.0, 0)));
  CHECK_FALSE(stands(60));
}
