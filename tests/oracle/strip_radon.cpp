// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/strip_radon.hpp"

#include <cmath>
#include <cstddef>

namespace vam::oracle {

namespace {

struct Point {
  double x, y;
};

/// The part of a convex polygon where side * (X cos + Y sin) <= limit.
std::vector<Point> clip(const std::vector<Point>& polygon, double c, double s, double side, double limit) {
  std::vector<Point> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point a = polygon[i];
    const Point b = polygon[(i + 1) % polygon.size()];
    const double da = side * (a.x * c + a.y * s) - limit;
    const double db = side * (b.x * c + b.y * s) - limit;
    if (da <= 0) kept.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      const double f = da / (da - db);
      kept.push_back({a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)});
    }
  }
  return kept;
}

/// Calls visit(pixel, bin, weight) for every pixel and every bin near its shadow.
template <class Visit>
void for_each_weight(const StripRadon& g, const Visit& visit) {
  for (std::size_t a = 0; a < g.theta_rad.size(); ++a) {
    const double c = std::cos(g.theta_rad[a]);
    const double s = std::sin(g.theta_rad[a]);
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        const double x = i - g.axis_x;
        const double y = j - g.axis_y;
        const double centre = x * c + y * s + 0.5 * (g.columns - 1);
        for (int bin = static_cast<int>(centre) - 3; bin <= static_cast<int>(centre) + 3; ++bin) {
          if (bin < 0 || bin >= g.columns) continue;
          const double weight = strip_area(x, y, g.theta_rad[a], bin - 0.5 * (g.columns - 1));
          if (weight == 0) continue;
          visit(static_cast<std::size_t>(j) * g.nx + static_cast<std::size_t>(i),
                a * static_cast<std::size_t>(g.columns) + static_cast<std::size_t>(bin),
                weight * std::exp(g.alpha_per_px * (-x * s + y * c)));
        }
      }
    }
  }
}

}  // namespace

double strip_area(double x, double y, double theta_rad, double t) {
  const double c = std::cos(theta_rad);
  const double s = std::sin(theta_rad);
  std::vector<Point> polygon{{x - 0.5, y - 0.5}, {x + 0.5, y - 0.5}, {x + 0.5, y + 0.5}, {x - 0.5, y + 0.5}};
  polygon = clip(polygon, c, s, 1, t + 0.5);
  polygon = clip(polygon, c, s, -1, -(t - 0.5));
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point a = polygon[i];
    const Point b = polygon[(i + 1) % polygon.size()];
    twice += (a.x - x) * (b.y - y) - (b.x - x) * (a.y - y);
  }
  return twice / 2;
}

std::vector<double> StripRadon::forward(const std::vector<double>& image) const {
  std::vector<double> sinogram(theta_rad.size() * static_cast<std::size_t>(columns), 0.0);
  for_each_weight(*this, [&](std::size_t pixel, std::size_t bin, double w) { sinogram[bin] += w * image[pixel]; });
  return sinogram;
}

std::vector<double> StripRadon::adjoint(const std::vector<double>& sinogram) const {
  std::vector<double> image(static_cast<std::size_t>(nx) * ny, 0.0);
  for_each_weight(*this, [&](std::size_t pixel, std::size_t bin, double w) { image[pixel] += w * sinogram[bin]; });
  return image;
}

}  // namespace vam::oracle
