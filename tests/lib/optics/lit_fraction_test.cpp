// SPDX-License-Identifier: GPL-3.0-or-later
// The share of the stage angles from which a point is lit.
#include "optics/lit_fraction.hpp"

#include "optics/writable_radius.hpp"
#include "oracle/ray_tracer.hpp"
#include "testing.hpp"

using namespace vam;
using optics::writable_radius_mm;

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
  model::Printer printer{.projector = {.lens_distance_mm = 120}, .vial = {.wall_mm = 0.5, .index_glass = 1.47}};
  oracle::Bench bench{.lens_distance = 120, .cylinders = {{12.7L, 1.47L}, {12.2L, 1.53L}}};
  const double writable = writable_radius_mm(printer);
  CHECK(optics::lit_fraction(printer, 0) == 1);
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

TEST_CASE("columns from half the radius to beyond it light a point from a third of all angles") {
  model::Printer printer;
  printer.projector.telecentric = true;
  printer.bath = {1.53, 20};  // straight rays
  printer.projector.columns = 101;
  printer.projector.axis_column = -0.5 - 3 / printer.projector.pixel_mm;  // from 3 mm on one side of the axis
  CHECK(optics::lit_fraction(printer, 6) == doctest::Approx(1.0 / 3).epsilon(1e-3));  // acos(3 / 6) / pi
}
