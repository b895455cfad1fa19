// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/part_2d.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace vam::oracle {

namespace {
constexpr int samples = 8;
constexpr double usable = 0.48;
}  // namespace

std::vector<float> draw(int size, const std::function<bool(double, double)>& inside) {
  std::vector<float> image;
  image.reserve(size * static_cast<std::size_t>(size));
  const double centre = 0.5 * (size - 1);
  for (int j = 0; j < size; ++j) {
    for (int i = 0; i < size; ++i) {
      int hits = 0;
      for (int s = 0; s < samples * samples; ++s) {
        const double x = i - centre + (s % samples + 0.5) / samples - 0.5;
        const double y = j - centre + (s / samples + 0.5) / samples - 0.5;
        if (std::hypot(x, y) <= usable * size && inside(x, y)) ++hits;
      }
      image.push_back(static_cast<float>(hits) / (samples * samples));
    }
  }
  return image;
}

std::vector<float> disc_grid(int size, double scale) {
  const double period = 35 * scale;
  const double radius = 8 * scale;
  const double last = usable * size - radius - 1;
  return draw(size, [=](double x, double y) {
    const double cx = std::round(x / period) * period;
    const double cy = std::round(y / period) * period;
    return std::hypot(cx, cy) <= last && std::hypot(x - cx, y - cy) <= radius;
  });
}

std::vector<float> gyroid(int size, double cells, double z, double level) {
  const double k = 2 * std::numbers::pi * cells / size;
  const double edge = 0.44 * size;
  return draw(size, [=](double x, double y) {
    const double value =
        std::sin(k * x) * std::cos(k * y) + std::sin(k * y) * std::cos(z) + std::sin(z) * std::cos(k * x);
    return std::hypot(x, y) <= edge && std::abs(value) < level;
  });
}

std::vector<float> wheel(int size) {
  return draw(size, [=](double x, double y) {
    const double r = std::hypot(x, y) / size;
    const double angle = std::atan2(y, x);
    const double spoke = std::abs(std::remainder(angle, 2 * std::numbers::pi / 5)) * r;
    return (r > 0.36 && r < 0.44) || r < 0.08 || (r < 0.4 && spoke < 0.02);
  });
}

namespace {

struct Box {
  double x0, y0, x1, y1;
  [[nodiscard]] bool holds(double x, double y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

/// Three bars as wide as their gaps, 5 widths long, upright or lying, lower left corner at (x, y).
void bars(std::vector<Box>& boxes, double x, double y, double width, bool upright) {
  for (int i = 0; i < 3; ++i) {
    const double at = 2 * i * width;
    boxes.push_back(upright ? Box{x + at, y, x + at + width, y + 5 * width}
                            : Box{x, y + at, x + 5 * width, y + at + width});
  }
}

}  // namespace

// Laid out in a frame of 512 units. Pixel centres are sampled once, so the target is binary.
std::vector<float> resolution_target(int size) {
  std::vector<Box> boxes;
  const double least = 2.0 * 512 / size;  // two pixels
  const auto width = [&](double w) { return std::max(w, least); };
  boxes.push_back({-195, -60, -155, 130});  // 40 wide, 40 apart
  boxes.push_back({-115, -60, -75, 130});
  bars(boxes, 40, -215, width(20), true);
  bars(boxes, -80, -200, width(20), false);
  bars(boxes, 40, 20, width(12), true);
  bars(boxes, 120, 20, width(12), false);
  bars(boxes, 40, -60, width(8), true);
  bars(boxes, 100, -60, width(8), false);
  bars(boxes, 160, -60, width(6), true);
  bars(boxes, 200, -60, width(4), true);
  bars(boxes, 160, -100, width(4), false);
  bars(boxes, 200, -100, width(3), false);
  // Letters V A M from strokes 10 units wide, upside up.
  const auto stroke = [](double x, double y, double ax, double ay, double bx, double by, double w) {
    const double ux = bx - ax;
    const double uy = by - ay;
    const double t = std::clamp(((x - ax) * ux + (y - ay) * uy) / (ux * ux + uy * uy), 0.0, 1.0);
    return std::hypot(x - ax - t * ux, y - ay - t * uy) <= w / 2;
  };
  const double unit = size / 512.0;
  const double centre = 0.5 * (size - 1);
  std::vector<float> image;
  for (int j = 0; j < size; ++j) {
    for (int i = 0; i < size; ++i) {
      const double x = (i - centre) / unit;
      const double y = (j - centre) / unit;
      bool in = std::any_of(boxes.begin(), boxes.end(), [&](const Box& b) { return b.holds(x, y); });
      in = in || stroke(x, y, -90, 200, -65, 140, 10) || stroke(x, y, -65, 140, -40, 200, 10);
      in = in || stroke(x, y, -25, 140, 0, 200, 10) || stroke(x, y, 0, 200, 25, 140, 10) ||
           stroke(x, y, -12, 160, 12, 160, 8);
      in = in || stroke(x, y, 45, 140, 45, 200, 10) || stroke(x, y, 45, 200, 65, 160, 10) ||
           stroke(x, y, 65, 160, 85, 200, 10) || stroke(x, y, 85, 200, 85, 140, 10);
      const double r = std::hypot(x + 130, y + 130);
      for (const double ring : {8.0, 20.0, 34.0}) in = in || std::abs(r - ring) < std::max(3.0, least / 2);
      image.push_back(in && std::hypot(x, y) < 0.47 * 512 ? 1.0F : 0.0F);
    }
  }
  return image;
}

}  // namespace vam::oracle
