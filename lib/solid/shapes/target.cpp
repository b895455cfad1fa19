// SPDX-License-Identifier: GPL-3.0-or-later
// Test targets: patterns whose dimensions are to be measured in the print.
#include <vector>

#include "solid/shapes/private/builders.hpp"
#include "solid/shapes/private/sdf.hpp"

namespace vam::solid::build {

// The pattern that shows uncorrected refraction: discs on a square grid, one on the axis, those that lie wholly within
// the diameter [RAY21 fig 7a: period 35 px, radius 8 px]. The cross-section is constant.
Field disc_grid(Values v) {
  const double period = v[0];
  const double radius = v[1];
  const double reach = v[2] / 2 - radius;  // of the centres
  const double half = v[3] / 2;
  require(2 * radius < period, "shape disc-grid: discs touch; radius must be below half of period");
  require(reach >= 0, "shape disc-grid: no disc fits; diameter must be at least 2 radius");
  const double inside = reach * reach * (1 + 1e-12);  // a disc that just touches the border counts
  const int most = static_cast<int>(reach / period) + 1;
  double extent = radius;
  double far = radius;
  for (int a = 0; a <= most; ++a) {
    for (int b = 0; b <= a; ++b) {
      if (period * period * (a * a + b * b) > inside) continue;
      extent = std::max(extent, a * period + radius);
      far = std::max(far, std::hypot(a, b) * period + radius);
    }
  }
  return solid(
      [=](const Point& p) {
        // The nearest lattice point may lie outside; then one of its neighbours towards the axis is nearest.
        const double a0 = std::round(p[0] / period);
        const double b0 = std::round(p[1] / period);
        double nearest = 1e300;
        for (int da = -1; da <= 1; ++da) {
          for (int db = -1; db <= 1; ++db) {
            const double x = (a0 + da) * period;
            const double y = (b0 + db) * period;
            if (x * x + y * y <= inside) nearest = std::min(nearest, std::hypot(p[0] - x, p[1] - y));
          }
        }
        if (nearest == 1e300) nearest = std::max(std::hypot(p[0], p[1]) - reach, radius + 0.5 * period);
        return sdf::rectangle(nearest, p[2], radius, half);
      },
      {-extent, -extent, -half}, {extent, extent, half}, far, 1 / radius);
}

// Two rails with rungs between them [CURE19 fig 2a]; gaps below the first and above the last rung.
Field ladder(Values v) {
  const double half_width = v[0] / 2;
  const double half_depth = v[1] / 2;
  const double rail = v[2];
  const double rung = v[3];
  const double gap = v[4];
  const double rungs = v[5];
  require(rail < half_width, "shape ladder: rail must be below half of width");
  const double half = 0.5 * (rungs * rung + (rungs + 1) * gap);
  return solid(
      [=](const Point& p) {
        const double rails =
            sdf::box({std::abs(p[0]) - (half_width - rail / 2), p[1], p[2]}, {rail / 2, half_depth, half});
        const double first = -half + gap + rung / 2;
        const double index = std::clamp(std::round((p[2] - first) / (rung + gap)), 0.0, rungs - 1);
        const double bar =
            sdf::box({p[0], p[1], p[2] - first - index * (rung + gap)}, {half_width, half_depth, rung / 2});
        return std::min(rails, bar);
      },
      {-half_width, -half_depth, -half}, {half_width, half_depth, half}, 1e300, 0);
}

namespace {

struct Bar {
  double middle;
  double half_width;
};

// Bars from 0 on, each followed by a gap of its own width; widths grow by a constant factor. The total width.
double lay_bars(int steps, double finest, double coarsest, std::vector<Bar>& bars) {
  double total = 0;
  for (int i = 0; i < steps; ++i) {
    const double width = steps == 1 ? finest : finest * std::pow(coarsest / finest, i / (steps - 1.0));
    bars.push_back({total + width / 2, width / 2});
    total += i + 1 < steps ? 2 * width : width;
  }
  return total;
}

// Distance to the nearest bar, negative within.
double nearest(const std::vector<Bar>& bars, double at) {
  double distance = 1e300;
  for (const Bar& bar : bars) distance = std::min(distance, std::abs(at - bar.middle) - bar.half_width);
  return distance;
}

}  // namespace

// On a round base: for y > 0 straight bars, for y < 0 half rings about the axis. Each bar is followed by a gap of its
// own width; widths grow by a constant factor, bars from left to right and rings from the axis outwards.
Field resolution(Values v) {
  const double finest = v[0];
  const double coarsest = v[1];
  const int steps = static_cast<int>(v[2]);
  const double radius = v[3] / 2;
  const double half = v[4] / 2;
  const double base = v[5];
  require(coarsest >= finest, "shape resolution: coarsest must not be below finest");
  require(base < 2 * half, "shape resolution: base must be below height");
  std::vector<Bar> bars;
  std::vector<Bar> rings;
  const double total = lay_bars(steps, finest, coarsest, bars);
  require(total <= 2 * radius, "shape resolution: bars are wider than diameter; reduce steps or coarsest");
  for (const Bar& bar : bars) {
    // The first ring leaves a hole of its own width around the axis.
    const double middle = bar.middle + finest;
    if (middle + bar.half_width <= radius) rings.push_back({middle, bar.half_width});
  }
  for (Bar& bar : bars) bar.middle -= total / 2;
  const double apart = finest;  // of bars and rings from the line y = 0
  return solid(
      [=](const Point& p) {
        const double r = std::hypot(p[0], p[1]);
        const double plate = sdf::cylinder({p[0], p[1], p[2] + half - base / 2}, radius, base / 2);
        const double pattern = p[1] >= 0 ? nearest(bars, p[0]) : nearest(rings, r);
        const double relief = std::max({pattern, apart - std::abs(p[1]), sdf::cylinder(p, radius, half)});
        return base > 0 ? std::min(plate, relief) : relief;
      },
      {-radius, -radius, -half}, {radius, radius, half}, radius, 1 / finest);
}

}  // namespace vam::solid::build
