// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/patterns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"

namespace vam::optics {

namespace {

constexpr int spokes = 36;

std::uint16_t to_level(double fraction, const GreyImage& image) {
  return static_cast<std::uint16_t>(std::lround(fraction * image.full()));
}

void fill(GreyImage& image, std::uint16_t level) { std::fill(image.values.begin(), image.values.end(), level); }

// A line of `width` pixels whose middle is nearest to the coordinate.
bool on_line(int pixel, double middle, int width) { return std::abs(pixel - middle) < 0.5 * width + 1e-9; }

// Is the pixel on one of the lines at origin + k * pitch?
bool on_grid(int pixel, double origin, const PatternPlan& plan) {
  const double k = std::round((pixel - origin) / plan.pitch_px);
  return on_line(pixel, origin + k * plan.pitch_px, plan.width_px);
}

// Alternating sectors, 2 * spokes of them: the finest visible circle indicates the blur.
bool on_spoke(int x, int y, const GreyImage& image) {
  const double angle = std::atan2(y - 0.5 * (image.height - 1), x - 0.5 * (image.width - 1));
  return floor_int((angle / std::numbers::pi + 1) * spokes) % 2 == 0;
}

template <class Lit>
void draw(GreyImage& image, std::uint16_t level, const Lit& lit) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (lit(x, y)) image(x, y) = level;
    }
  }
}

}  // namespace

const std::vector<std::string>& pattern_names() {
  static const std::vector<std::string> names{"star", "axis", "grid", "grey", "ramp", "sweep", "row", "blink"};
  return names;
}

void set_lines(PatternPlan& plan, std::optional<int> pitch_px, std::optional<int> width_px) {
  const bool sweep = plan.name == "sweep";
  plan.pitch_px = pitch_px.value_or(sweep ? sweep_line_px : PatternPlan{}.pitch_px);
  plan.width_px = width_px.value_or(sweep ? sweep_line_px : PatternPlan{}.width_px);
}

int pattern_frames(const PatternPlan& plan, const model::Projector& projector) {
  const auto& names = pattern_names();
  if (std::find(names.begin(), names.end(), plan.name) == names.end()) {
    throw Error{Fault::usage,
                "pattern '" + plan.name + "' is not one of " + join(names, ", ") + did_you_mean(plan.name, names)};
  }
  if (plan.name == "ramp") return plan.steps;
  if (plan.name == "blink") return 2;
  if (plan.name == "sweep") return (projector.columns + plan.pitch_px - 1) / plan.pitch_px;
  return 1;
}

std::vector<int> pattern_order(const PatternPlan& plan, const model::Projector& projector) {
  std::vector<int> order(static_cast<std::size_t>(pattern_frames(plan, projector)));
  std::iota(order.begin(), order.end(), 0);
  if (plan.name != "blink") return order;
  order.assign(127, 1);  // longest sequence of x^7 + x + 1; a prime number of steps, so that every nth make one, too
  for (std::size_t n = 7; n < order.size(); ++n) order[n] = order[n - 6] ^ order[n - 7];
  return order;
}

GreyImage pattern_frame(const PatternPlan& plan, const model::Projector& projector, int n) {
  GreyImage image(projector.columns, projector.rows, projector.bits);
  const std::uint16_t level = to_level(plan.level, image);
  if (plan.name == "ramp") {
    fill(image, to_level(plan.steps > 1 ? static_cast<double>(n) / (plan.steps - 1) : 1.0, image));
  } else if (plan.name == "blink" && n == 0) {
    fill(image, 0);
  } else if (plan.name == "grey" || plan.name == "blink") {
    fill(image, level);
  } else if (plan.name == "star") {
    draw(image, level, [&](int x, int y) { return on_spoke(x, y, image); });
  } else if (plan.name == "sweep") {
    const int first = n * plan.pitch_px;
    draw(image, level, [&](int x, int) { return x >= first && x < first + plan.width_px; });
  } else if (plan.name == "row") {
    draw(image, level, [&](int, int y) { return on_line(y, projector.axis_row, plan.width_px); });
  } else if (plan.name == "axis") {
    draw(image, level, [&](int x, int y) {
      return on_line(x, projector.axis_column, plan.width_px) || on_line(y, projector.axis_row, plan.width_px);
    });
  } else {
    draw(image, level,
         [&](int x, int y) { return on_grid(x, projector.axis_column, plan) || on_grid(y, projector.axis_row, plan); });
  }
  return image;
}

}  // namespace vam::optics
