// SPDX-License-Identifier: GPL-3.0-or-later
// Resampling where numbers are round and columns fall on the rim of the vial: every plan is finite and bounded, covers
// what is seen, and is what traced rays say.
#include <chrono>

#include "base/image.hpp"
#include "base/index.hpp"
#include "lib/optics/view_bench.hpp"
#include "optics/chief_ray.hpp"
#include "optics/resample.hpp"
#include "optics/writable_radius.hpp"
#include "oracle/ray_tracer.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optics;

namespace {

constexpr double turn_rad = 2 * std::numbers::pi;

struct Rig {
  View view;
  Detector real;  // the camera or projector
  Detector virtual_;
  Turn turn;
  ResampleOptions options;
};

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool chance(double p) { return std::bernoulli_distribution(p)(random_); }
  double of(const std::vector<double>& values) { return values[whole(0, static_cast<int>(values.size()) - 1)]; }

 private:
  std::mt19937 random_;
};

View round_view(Draw& draw, double radius_mm, double pixel_mm) {
  View view;
  const double resin = draw.of({1.33, 1.4, 1.49, 1.5, 1.53});
  const double bath = draw.whole(0, 4);  // air, another liquid, else matched
  view.bath_index = bath == 0 ? 1.0 : bath == 1 ? draw.of({1.33, 1.45, 1.6}) : resin;
  const double away = draw.of({1, 2, 4, 10});
  view.window_mm = draw.chance(0.3) ? radius_mm : radius_mm + draw.of({0.1, 1, 5, 17.6});
  if (draw.chance(0.7)) view.lens_mm = std::max(view.window_mm, away * radius_mm) + draw.of({0.001, 0.155, 10, 137.6});
  if (draw.chance(0.3)) {
    const double wall = pixel_mm * draw.whole(0, 4);
    view.shells.push_back({radius_mm, draw.chance(0.5) ? resin : draw.of({1.33, 1.47, 1.52})});
    view.shells.push_back({radius_mm - wall, resin});
  } else {
    view.shells.push_back({radius_mm, resin});
  }
  return view;
}

/// The radius is mostly a whole number of pixels, or a half more, so that columns are on the rim.
Rig round_rig(Draw& draw) {
  Rig rig;
  const double pixel_mm = draw.of({0.05, 0.1, 0.12, 0.155, 0.2, 0.31});
  const int even = draw.whole(0, 1);
  const double columns_across = draw.whole(8, 40) + 0.5 * even;
  const double radius_mm = draw.chance(0.8) ? columns_across * pixel_mm : draw.real(8, 40) * pixel_mm;
  rig.view = round_view(draw, radius_mm, pixel_mm);
  const int side = draw.chance(0.5) ? static_cast<int>(columns_across) : draw.whole(2, 60);
  rig.real = centred_detector(2 * side + 1 + even, pixel_mm);
  if (draw.chance(0.2)) rig.real.axis_column += draw.of({0.5, 0.37, -3, 1});
  const double finer = draw.chance(0.05) ? draw.of({1e-2, 1e4, 1e9}) : draw.of({0.5, 1, 1, 1, 1.5, 2, 3});
  const double pitch_mm = draw.chance(0.1) ? radius_mm / draw.whole(3, 50) : finer * pixel_mm;
  const double reach = reach_mm(rig.view);
  const int half = static_cast<int>(std::min(std::round(reach / pitch_mm), 200.0));
  rig.virtual_ = centred_detector(2 * half + 1 + (draw.chance(0.8) ? even : draw.whole(0, 2)), pitch_mm);
  const int rows = draw.whole(4, 9);
  rig.turn = {rows, draw.of({0, 0.3}), turn_rad / rows};
  rig.options = {draw.chance(0.5) ? Interpolation::linear : Interpolation::cubic, draw.chance(0.8), draw.chance(0.5),
                 draw.of({0, std::numbers::pi / 2, -7}), draw.chance(0.5) ? 1 : -1};
  return rig;
}

/// Largest sum of absolute weights of a column; infinite where anything is not as a plan must be.
double heaviest(const ResamplePlan& plan) {
  constexpr double broken = HUGE_VAL;
  double most = 0;
  for (const ColumnSource& source : plan.sources) {
    if (source.count == 0) continue;
    if (source.count < 0 || source.first < 0 || source.first + source.count > plan.columns_in) return broken;
    if (source.row < 0 || source.row >= plan.rows) return broken;
    double turned = 0;
    for (const float weight : source.angle_weights) turned += static_cast<double>(weight);
    if (!(std::abs(turned - 1) < 1e-6)) return broken;
    double sum = 0;
    for (int k = 0; k < source.count; ++k) sum += std::abs(static_cast<double>(plan.weights[source.weights + k]));
    if (!(sum > 0 && std::isfinite(sum))) return broken;
    most = std::max(most, sum);
  }
  return most;
}

bool on(const Detector& detector, double column) { return column > -0.4 && column < detector.columns - 0.6; }

/// Columns within reach by the chief rays that traced ones judge below, and of which the plan has nothing.
int uncovered(const Rig& rig, const ResamplePlan& plan, bool to_virtual) {
  const double inside = (1 - 1e-6) * reach_mm(rig.view);
  int missing = 0;
  for (int c = 0; c < plan.columns_out; ++c) {
    bool seen = false;
    if (to_virtual) {
      const double x_v = rig.virtual_.x_mm(c);
      const double impact = x_v * rig.view.shells.back().index / rig.view.bath_index;
      seen = std::abs(x_v) < inside && on(rig.real, rig.real.column(column_of_impact(rig.view, impact)));
    } else {
      const double impact = impact_mm(rig.view, rig.real.x_mm(c));
      const double x_v = impact * rig.view.bath_index / rig.view.shells.back().index;
      seen = std::abs(x_v) < inside && on(rig.virtual_, rig.virtual_.column(x_v));
    }
    if (seen && plan.sources[c].count == 0) ++missing;
  }
  return missing;
}

Image apply(const ResamplePlan& plan, const Image& in) {
  std::vector<Image> out(1);
  resample(plan, {&in, 1}, out);
  return out.front();
}

struct Traced {
  double t = 0, a = 0, transmittance = 1;
};
std::optional<Traced> traced(const View& view, double x_mm) {
  const auto ray = vam::oracle::trace(bench_of(view), x_mm);
  if (!ray) return std::nullopt;
  const auto line = vam::oracle::line_of(*ray);
  return Traced{static_cast<double>(line.t), static_cast<double>(line.a), static_cast<double>(ray->transmittance)};
}

/// The column of a line by halving: no inverse, no invariant.
double traced_column(const View& view, double x_v_mm) {
  double low = -4 * view.shells.front().radius_mm;
  double high = -low;
  for (int step = 0; step < 100; ++step) {
    const double middle = 0.5 * (low + high);
    const auto ray = traced(view, middle);
    const double t = ray ? ray->t : middle > 0 ? HUGE_VAL : -HUGE_VAL;
    (t < x_v_mm ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Smooth over columns and rows.
double wave(double x_mm, double radius_mm, double theta) {
  return 1 + 0.4 * std::sin(1.5 * x_mm / radius_mm + 0.2) + 0.3 * std::cos(theta - 0.4) * std::cos(x_mm / radius_mm);
}

Image wave_on(const Detector& detector, double radius_mm, const Turn& turn) {
  Image image(detector.columns, turn.rows);
  for (const auto [a, c] : indices(image.height, image.width)) {
    image(c, a) = static_cast<float>(wave(detector.x_mm(c), radius_mm, turn.start_rad + a * turn.step_rad));
  }
  return image;
}

}  // namespace

TEST_CASE("10,000 round configurations: plans are finite, bounded and cover what is seen") {
  // A cubic kernel's absolute weights add up to 1.25, stretched and mended to 1.4; light is made at most 100 times as
  // bright.
  constexpr double most = 1.4;
  Draw draw(3);
  for (int trial = 0; trial < 10000; ++trial) {
    CAPTURE(trial);
    const Rig rig = round_rig(draw);
    double least_j = 1;
    double most_j = 1;
    for (double c = -0.5; c <= rig.real.columns - 0.5; c += 0.5) {
      const ChiefRay ray = chief_ray(rig.view, rig.real.x_mm(c));
      if (!ray.hits || !rig.options.jacobian) continue;
      least_j = std::min(least_j, ray.jacobian);
      most_j = std::max(most_j, ray.jacobian);
    }
    const double brightest = most * (rig.options.fresnel ? 100 : 1);
    const auto start = std::chrono::steady_clock::now();
    for (const bool to_virtual : {false, true}) {
      CAPTURE(to_virtual);
      const ResamplePlan plan = to_virtual ? plan_to_virtual(rig.view, rig.real, rig.virtual_, rig.turn, rig.options)
                                           : plan_to_projector(rig.view, rig.virtual_, rig.real, rig.turn, rig.options);
      REQUIRE(heaviest(plan) < brightest * (to_virtual ? 1 / least_j : most_j));
      REQUIRE(plan.weights.size() < 10 * (product(plan.columns_in, 1) + product(plan.columns_out, 1)));
      REQUIRE(uncovered(rig, plan, to_virtual) == 0);
      if (trial % 4 != 0) continue;
      const Image out = apply(plan, Image(plan.columns_in, plan.rows, 1.0F));
      REQUIRE(std::all_of(out.values.begin(), out.values.end(), [](float v) { return std::isfinite(v); }));
    }
    CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < 2);
  }
}

TEST_CASE("resampling is what traced rays say, in both directions") {
  constexpr double radius_mm = 12.4;
  constexpr double pixel_mm = 0.155;  // 80 to the rim
  for (const View& view : {View{150, 1.53, 30, {{radius_mm, 1.53}}}, View{std::nullopt, 1.53, 30, {{radius_mm, 1.53}}},
                           View{150, 1.0, 0, {{radius_mm, 1.53}}}, View{60, 1.45, 12.4, {{radius_mm, 1.5}}},
                           View{150, 1.5, 20, {{radius_mm, 1.47}, {11.4, 1.5}}}}) {
    CAPTURE(view.bath_index);
    const Detector real = centred_detector(221, pixel_mm);
    const Detector virtual_ = centred_detector(161, pixel_mm);
    const Turn turn{120, 0, turn_rad / 120};
    ResampleOptions plain{.jacobian = false};
    const double inside = 0.97 * reach_mm(view);
    double worst = 0;
    const Image to_real =
        apply(plan_to_projector(view, virtual_, real, turn, plain), wave_on(virtual_, radius_mm, turn));
    for (int c = 0; c < real.columns; ++c) {
      const auto ray = traced(view, real.x_mm(c));
      if (!ray || std::abs(ray->t) > inside) continue;
      for (int a = 0; a < turn.rows; ++a) {
        const double want = wave(ray->t, radius_mm, a * turn.step_rad + ray->a) / ray->transmittance;
        worst = std::max(worst, std::abs(static_cast<double>(to_real(c, a)) - want));
      }
    }
    CHECK(worst < 1e-4);  // the third order of a wave of 50 columns a radian
    worst = 0;
    const Image back = apply(plan_to_virtual(view, real, virtual_, turn, plain), wave_on(real, radius_mm, turn));
    for (int c = 0; c < virtual_.columns; ++c) {
      const double x_v = virtual_.x_mm(c);
      if (std::abs(x_v) > inside) continue;
      const double x_c = traced_column(view, x_v);
      const auto ray = traced(view, x_c);
      REQUIRE(ray.has_value());
      for (int a = 0; a < turn.rows; ++a) {
        const double want = wave(x_c, radius_mm, a * turn.step_rad - ray->a) / ray->transmittance;
        worst = std::max(worst, std::abs(static_cast<double>(back(c, a)) - want));
      }
    }
    CHECK(worst < 1e-4);
  }
}
