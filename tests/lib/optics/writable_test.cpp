// How far from the axis a printer writes.
#include "optics/writable.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/error.hpp"
#include "oracle/ray_tracer.hpp"

using namespace vam;
using optics::writable_radius_mm;

TEST_CASE("the default printer writes up to the outermost ray of the vial") {
  CHECK(writable_radius_mm({}) == doctest::Approx(12.7 / 1.53));
}

TEST_CASE("a glass wall does not narrow what is lit, until the resin itself ends") {
  model::Printer printer;
  printer.vial.wall_mm = 1;
  CHECK(writable_radius_mm(printer) == doctest::Approx(12.7 / 1.53));
  printer.vial.wall_mm = 6;
  CHECK(writable_radius_mm(printer) == doctest::Approx(6.7));
}

TEST_CASE("a matched bath opens the whole vial") {
  model::Printer printer;
  printer.bath = {1.53, 20};
  CHECK(writable_radius_mm(printer) == doctest::Approx(12.7));
}

TEST_CASE("few columns narrow it, the narrower side decides") {
  model::Printer printer;
  printer.projector.lens_distance_mm = 120;
  printer.projector.columns = 201;
  printer.projector.axis_column = 100;
  const double edge_mm = 100 * 0.065;
  const double narrow = edge_mm / std::hypot(1, edge_mm / 120) / 1.53;  // b / n, in air
  CHECK(writable_radius_mm(printer) == doctest::Approx(narrow));
  printer.projector.axis_column = 120;
  CHECK(writable_radius_mm(printer) < narrow);
  printer.projector.telecentric = true;
  CHECK(writable_radius_mm(printer) == doctest::Approx(80 * 0.065 / 1.53));
  printer.projector.axis_column = 201;
  CHECK_THROWS_WITH_AS((void)writable_radius_mm(printer), doctest::Contains("beside its columns 0 ... 200"), Error);
}

TEST_CASE("a printer whose lens stands in the vial has none") {
  model::Printer printer;
  printer.projector.lens_distance_mm = 10;
  CHECK_THROWS_AS((void)writable_radius_mm(printer), Error);
}

namespace {

// The share of half degrees of a circle that rays traced by vector Snell pass.
double crossed(const oracle::Bench& bench, double half_width_mm, double radius_mm) {
  constexpr int directions = 720;
  std::vector<char> lit(directions, 0);
  const auto mark = [&](double rad) {
    const double turn = rad / (2 * std::numbers::pi);
    lit[static_cast<std::size_t>((turn - std::floor(turn)) * directions) % directions] = 1;
  };
  constexpr int rays = 400000;
  for (int i = 0; i < rays; ++i) {
    const double x = half_width_mm * (2.0 * i / (rays - 1) - 1);
    const auto ray = oracle::trace(bench, x);
    if (!ray) continue;
    const oracle::Line line = oracle::line_of(*ray);
    const auto t = static_cast<double>(line.t);
    if (std::abs(t) >= radius_mm) continue;
    const double half = std::acos(t / radius_mm);
    mark(static_cast<double>(line.a) + half);
    mark(static_cast<double>(line.a) - half);
  }
  return static_cast<double>(std::count(lit.begin(), lit.end(), 1)) / directions;
}

}  // namespace

TEST_CASE("beyond the writable radius light comes from the angles that traced rays cross") {
  model::Printer printer;
  printer.vial.wall_mm = 0.5;
  printer.vial.index_glass = 1.47;
  printer.projector.lens_distance_mm = 120;
  oracle::Bench bench;
  bench.lens_distance = 120;
  bench.cylinders = {{12.7L, 1.47L}, {12.2L, 1.53L}};
  const double writable = writable_radius_mm(printer);
  CHECK(optics::lit_fraction(printer, 0.99 * writable) == 1);
  double before = 1;
  for (const double radius : {1.05 * writable, 1.15 * writable, 1.3 * writable, 12.0}) {
    const double fraction = optics::lit_fraction(printer, radius);
    CHECK(fraction == doctest::Approx(crossed(bench, 40, radius)).epsilon(0.01));  // the counts' directions are 0.5 deg
    CHECK(fraction < before);
    before = fraction;
  }
}

TEST_CASE("few columns light the rim from some angles") {
  model::Printer printer;
  printer.projector.telecentric = true;
  printer.bath = {1.53, 20};  // straight rays: a point at r is lit where |r cos alpha| is within the columns
  printer.projector.columns = 101;
  printer.projector.axis_column = 50;
  const double half_mm = 50.5 * printer.projector.pixel_mm;
  CHECK(optics::lit_fraction(printer, 2 * half_mm) ==
        doctest::Approx(2 * std::asin(0.5) / std::numbers::pi).epsilon(1e-3));
}

TEST_CASE("all resin is judged for a part that reaches beyond the writable radius") {
  const model::Printer printer;
  CHECK(optics::judged_radius_mm(printer, 8.3) == writable_radius_mm(printer));
  CHECK(optics::judged_radius_mm(printer, 8.31) == 12.7);
}
