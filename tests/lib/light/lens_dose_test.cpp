// SPDX-License-Identifier: GPL-3.0-or-later
// The oracle of light that has width, judged by closed forms: where a bundle in a vial is narrow, and what it is in the
// plane.
#include "oracle/lens_dose.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace vam::oracle;

namespace {

constexpr double turn = 2 * std::numbers::pi, deg = turn / 360;

LensBench vial() {
  LensBench bench;
  bench.radius = 12.7;
  bench.pixel = 0.1;
  bench.absorption = 0.05;
  bench.frames = 120;
  return bench;
}

double offset(const ResinRay& ray) {
  return (ray.at.x * ray.along.y - ray.at.y * ray.along.x) / std::hypot(ray.along.x, ray.along.y);
}

/// Where a ray is, across and along z, where the chief ray of its column has the depth u.
PupilPoint at_depth(const LensBench& bench, double column, const PupilPoint& point, double u) {
  const LensPoint chief = trace_in(bench, column, 0, {}).along;
  const ResinRay ray = trace_in(bench, column, 0, point);
  const auto across = [&](const LensPoint& p) {
    return (p.x * chief.y - p.y * chief.x) / std::hypot(chief.x, chief.y);
  };
  const auto deep = [&](const LensPoint& p) { return (p.x * chief.x + p.y * chief.y) / std::hypot(chief.x, chief.y); };
  const double s = (u - deep(ray.at)) / deep(ray.along);
  return {across(ray.at) + s * across(ray.along), ray.at.z + s * ray.along.z};
}

/// Sharp light as an optimiser finds it: filtered projections of discs, without what is negative.
double disc_light(const LensBench& bench, int frame, int column) {
  const double b = (column + 0.5) * bench.pixel / bench.radius;
  if (std::abs(b) >= 1) return 0;
  const double theta = turn * frame / bench.frames + std::asin(b) - std::asin(b / bench.resin);
  double sum = 0;
  for (int i = 0; i < 6; i++) {
    const double middle = i == 0 ? 0 : 4.2 * std::cos(theta - turn * i / 5), radius = i == 0 ? 2 : 1.2;
    const double off = std::abs(b * bench.radius / bench.resin - middle);
    sum += off < radius ? 1 : 1 - off / std::sqrt(off * off - radius * radius);
  }
  return std::max(0.0, sum);
}

}  // namespace

TEST_CASE("light of a lens followed forwards leaves what is found backwards") {
  LensBench bench = vial();
  SUBCASE("telecentric") {}
  SUBCASE("diverging") { bench.column_throw = bench.row_throw = 40; }
  SUBCASE("window") { bench.column_throw = 40, bench.bath = 1.4, bench.window = 20; }
  bench.pixel = 0.6, bench.wall = 1, bench.glass = 1.47, bench.focus = 2, bench.frames = 6;
  bench.pupil = round_pupil(1.5 * deg, 2);
  bench.hold = held(turn / 12, 2);
  const Frames frames = [](int frame, int row, int column) {
    return column > 5 ? 0.3 : 1 + 0.8 * std::sin(column * 0.9 + frame) * std::cos(row * 0.7 - frame * 0.3);
  };
  double mean = 0;
  for (int i = 0; i < 125; i++) {
    const auto place = [&](int k) { return (k % 5 - 2) / 10.0; };
    mean += lens_dose(bench, frames, {5 + place(i), 3.4 + place(i / 5), 0.3 + place(i / 25)}) / 125;
  }
  CHECK(deposited_lens_dose(bench, frames, {5, 3.4, 0.3}, 0.5, 17, 2, 8) / mean == doctest::Approx(1).epsilon(0.002));
}

// `behind` is how far the image of a column is behind the foot of the perpendicular from the axis on its chief ray.
TEST_CASE("a bundle in a vial has one focus in the plane and another along z") {
  LensBench bench = vial();
  SUBCASE("telecentric") {}
  SUBCASE("without refraction") { bench.resin = 1, bench.focus = 2; }
  SUBCASE("diverging") { bench.column_throw = bench.row_throw = 120; }
  SUBCASE("wall, refocused") { bench.column_throw = 120, bench.wall = 1, bench.glass = 1.47, bench.focus = -3; }
  const double n = bench.resin, inside = bench.radius - bench.wall, glass = bench.wall > 0 ? bench.glass : n;
  for (const double t : {0.0, 3.0, 6.0, 8.0}) {
    double x = n * t;
    for (int i = 0; i < 30; i++) x += n * (t - offset(trace_in(bench, x, 0, {})));
    const double phi = bench.column_throw > 0 ? std::atan(x / bench.column_throw) : 0, b = x * std::cos(phi);
    const double behind = x * std::sin(phi) + bench.focus / std::cos(phi);
    const auto half = [&](double radius, double index) { return std::sqrt(index * index * radius * radius - b * b); };
    const double bent =
        1 / half(bench.radius, 1) - 1 / half(bench.radius, glass) + 1 / half(inside, glass) - 1 / half(inside, n);
    const double wall = (half(bench.radius, glass) - half(inside, glass)) / glass / glass;
    const auto across = [&](double u) {
      return (at_depth(bench, x, {1e-5, 0}, u).x - at_depth(bench, x, {-1e-5, 0}, u).x) / 2e-5;
    };
    const auto height = [&](double u) { return at_depth(bench, x, {0, 1e-5}, u).z / 1e-5; };
    CHECK(std::abs(across(behind / n / (1 + behind * bent))) < 1e-6);
    CHECK(std::abs(across(5) - across(4) - (1 + behind * bent) * std::pow(std::cos(phi), 2)) < 1e-6);
    CHECK(std::abs(height(n * (half(bench.radius, 1) + behind - wall) - half(inside, n) / n)) < 1e-6);
    CHECK(std::abs(height(5) - height(4) - std::cos(phi) / n) < 1e-6);
  }
}

TEST_CASE("the bundle of a parallel beam is sharp on the axis in the plane, and wide along z") {
  double square = 0;
  for (const PupilPoint& point : round_pupil(1.5 * deg, 4)) {
    const PupilPoint ray = at_depth(vial(), 0, point, 0);
    CHECK(std::abs(ray.x) < 1e-9);
    square += point.weight * ray.z * ray.z;
  }
  CHECK(std::abs(std::sqrt(square) - 6.35 * 1.5 * deg / 3) < 2e-5);  // 0.055 mm
  // Rays that aim at the axis keep it: what is left is t (1 - cos a).
  const double t = offset(trace_in(vial(), 12, 0, {std::tan(1.5 * deg), 0}));
  CHECK(std::abs(t - 8 * std::cos(1.5 * deg)) < 1e-6);
}

TEST_CASE("rays of a vial are those of [RAY21]") {
  LensBench bench = vial();
  bench.radius = 212.37, bench.resin = 1.53, bench.column_throw = 1843.2;
  const ResinRay ray = trace_in(bench, 200, 0, {});
  CHECK(std::abs(offset(ray) - 129.9562) < 1e-4);
  CHECK(std::abs(ray.transmitted - 0.83056) < 1e-5);
}

TEST_CASE("stage angles of a hold and of a round lens have the moments of a box and of a disc") {
  const auto moment = [](const std::vector<HoldAngle>& angles, int power) {
    double sum = 0;
    for (const HoldAngle& angle : angles) sum += angle.weight * std::pow(angle.angle, power);
    return sum;
  };
  CHECK(moment(chords(2, 3), 0) == doctest::Approx(1));
  CHECK(moment(chords(2, 3), 2) == doctest::Approx(1));
  CHECK(moment(chords(2, 3), 4) == doctest::Approx(2));
  CHECK(moment(held(2, 4), 1) == doctest::Approx(0));
  CHECK(moment(held(2, 4), 2) == doctest::Approx((1 - 1.0 / 16) / 3));
}

TEST_CASE("in the plane a round lens is light at a range of stage angles, weighted by its chords") {
  LensBench bench = vial();
  const double a = 0.64 * deg;
  const auto percent = [&](double angle, double focus) {  // RMS of the largest dose
    LensBench wide = bench, turned = bench;
    wide.focus = focus, wide.hold = held(turn / 120, 4), wide.pupil.clear(), turned.hold.clear();
    for (const HoldAngle& chord : chords(a, 9)) wide.pupil.push_back({std::tan(chord.angle), 0, chord.weight});
    for (const HoldAngle& chord : chords(angle, 9)) {
      for (const HoldAngle& part : wide.hold) {
        turned.hold.push_back({chord.angle + part.angle, chord.weight * part.weight});
      }
    }
    const Frames frames = [&](int frame, int, int column) { return disc_light(bench, frame, column); };
    double sum = 0, largest = 0;
    for (int i = 0; i < 12; i++) {
      const LensPoint at{6 * std::cos(i * i), 3 * std::sin(7 * i), 0};
      const double dose = lens_dose(wide, frames, at);
      largest = std::max(largest, dose);
      sum += std::pow(lens_dose(turned, frames, at) - dose, 2);
    }
    return 100 * std::sqrt(sum / 12) / largest;
  };
  CHECK(percent(a, 0) < 0.016);
  CHECK(percent(a / bench.resin, 0) > 0.05);  // the angle in the resin of a flat face
  CHECK(percent(a, 3) > 0.05);                // no convolution with a focus off the axis
}
