#include "light/shadowed_turn.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.hpp"
#include "optics/resample.hpp"

namespace vam::light {

namespace {

static_assert(light::InsertShadow::lanes == lanes);

std::vector<double> angles_of(const tomo::ParallelGeometry& geometry) {
  std::vector<double> angles;
  for (int a = 0; a < geometry.angles; ++a) angles.push_back(geometry.angle_start_rad + a * geometry.angle_step_rad);
  return angles;
}

std::vector<light::RayLine> lines_of(int columns, double column_mm) {
  const optics::Detector detector = optics::centred_detector(columns, column_mm);
  std::vector<light::RayLine> lines;
  for (int c = 0; c < columns; ++c) lines.push_back({true, detector.x_mm(c), 0});
  return lines;
}

/// How much of a trapezoid footprint (two boxes folded, middle at 0) lies left of t: the integral of a ramp at each of
/// its four corners.
double left_of(double t, double wide, double narrow) {
  const auto ramp = [](double x) { return x > 0 ? 0.5 * x * x : 0.0; };
  const double outer = 0.5 * (wide + narrow);
  const double inner = 0.5 * (wide - narrow);
  if (narrow < 1e-6) return std::clamp(t / wide + 0.5, 0.0, 1.0);
  return (ramp(t + outer) - ramp(t + inner) - ramp(t - inner) + ramp(t - outer)) / (wide * narrow);
}

}  // namespace

ShadowedTurn::ShadowedTurn(const tomo::ParallelGeometry& geometry, const model::Grid& grid, double column_mm)
    : geometry_(geometry), grid_(grid), shadow_(grid, angles_of(geometry), lines_of(geometry.columns, column_mm)) {
  for (const double theta : angles_of(geometry)) angles_.push_back({std::cos(theta), std::sin(theta)});
}

void ShadowedTurn::back_project(const Slab& sinogram, std::span<const Image> inserts, Slab& image) {
  shadow_.cast(inserts);
  parallel_for(geometry_.ny, [&](int y) {
    for (int x = 0; x < geometry_.nx; ++x) {
      float dose[lanes] = {};
      for (int a = 0; a < geometry_.angles; ++a) add_light(sinogram, x, y, a, dose);
      std::copy_n(dose, lanes, image.at(x, y));
    }
  });
}

void ShadowedTurn::add_light(const Slab& sinogram, int x, int y, int angle, float* dose) const {
  const auto [c, s] = angles_[static_cast<std::size_t>(angle)];
  const double wide = std::max(std::abs(c), std::abs(s));
  const double narrow = std::min(std::abs(c), std::abs(s));
  const double dx = x - geometry_.axis_x;
  const double dy = y - geometry_.axis_y;
  const double t = dx * c + dy * s + 0.5 * (geometry_.columns - 1);
  const double gain = std::exp(geometry_.alpha_per_px * (dy * c - dx * s));
  const int first = static_cast<int>(std::floor(t - 0.5 * (wide + narrow) + 0.5));
  double before = 0;
  for (int column = first; column < first + 3; ++column) {
    const double up_to = left_of(column + 0.5 - t, wide, narrow);
    if (column >= 0 && column < geometry_.columns && up_to > before) {
      const float depth = shadow_.depth_mm(grid_.x_mm(x), grid_.y_mm(y), angle, column);
      shadow_.add(angle, column, depth, static_cast<float>(gain * (up_to - before)), sinogram.at(column, angle), dose);
    }
    before = up_to;
  }
}

}  // namespace vam::light
