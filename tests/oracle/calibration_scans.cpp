#include "oracle/calibration_scans.hpp"

#include <algorithm>
#include <cmath>

#include "oracle/ray_tracer.hpp"

namespace vam::oracle {

namespace {

constexpr double step_px = 0.05;

double noisy(double value, double read_noise, Random& random) {
  std::normal_distribution<double> unit;
  constexpr double electrons = 10;  // a unit of light
  return value + std::sqrt(read_noise * read_noise + std::max(value, 0.0) / electrons) * unit(random);
}

}  // namespace

SweepBench::SweepBench(const SweepTruth& truth) : truth_(truth) {
  Bench bench;
  bench.lens_distance = truth.lens_mm;
  if (truth.wall_mm > 0) bench.cylinders.push_back({truth.radius_mm, truth.glass_index});
  const double inner_mm = truth.radius_mm - truth.wall_mm;
  bench.cylinders.push_back({inner_mm, truth.resin_index});
  const int nodes = static_cast<int>(1.2 * truth.radius_mm / truth.pixel_mm / step_px);
  for (int i = 0; i < nodes; ++i) {
    const auto ray = trace(bench, i * step_px * truth.pixel_mm);
    if (!ray) {
      table_.push_back(0);
      continue;
    }
    // The way from the entry to the resin out of it again: twice the distance to the point nearest to the axis.
    const Real along = ray->point[0] * ray->direction[0] + ray->point[1] * ray->direction[1];
    table_.push_back(static_cast<double>(-2 * along * ray->transmittance) / (2 * inner_mm));
  }
}

double SweepBench::fluorescence(double x_px) const {
  const double place = std::abs(x_px) / step_px;
  const auto i = static_cast<std::size_t>(place);
  if (i + 1 >= table_.size()) return 0;
  const double part = place - std::floor(place);
  // The camera gets more of a sheet that turns towards it: the turn is asin(b / R) - asin(b / n R), b the distance
  // of the ray from the axis.
  const double x_mm = x_px * truth_.pixel_mm;
  const double b = std::clamp(x_mm / std::hypot(1, x_mm / truth_.lens_mm) / truth_.radius_mm, -1.0, 1.0);
  const double gain = 1 + truth_.slope * (std::asin(b) - std::asin(b / truth_.resin_index));
  return gain * ((1 - part) * table_[i] + part * table_[i + 1]);
}

Image SweepBench::frame(double line_column, double width_px, const std::vector<double>& height_mm, int columns,
                        Random& random) const {
  Image image(columns, static_cast<int>(height_mm.size()));
  for (int row = 0; row < image.height; ++row) {
    const double axis =
        truth_.axis_column + std::tan(truth_.tilt_rad) * height_mm[static_cast<std::size_t>(row)] / truth_.pixel_mm;
    double light = 0;
    double weights = 0;
    for (int g = -6; g <= 6; ++g) {  // the blur
      const double z = g / 2.0;
      for (int k = 0; k < 6; ++k) {  // across the line
        const double x = line_column - axis + truth_.blur_px * z + width_px * ((k + 0.5) / 6 - 0.5);
        light += std::exp(-z * z / 2) * fluorescence(x);
        weights += std::exp(-z * z / 2);
      }
    }
    light *= 100 / weights;
    for (int x = 0; x < columns; ++x) image(x, row) = static_cast<float>(noisy(20 + light, truth_.noise, random));
  }
  return image;
}

Image bright_band(const BandTruth& truth, Random& random) {
  Image image(truth.columns, truth.rows);
  for (int y = 0; y < truth.rows; ++y) {
    const double middle = truth.middle + truth.lean * (y - 0.5 * (truth.rows - 1));
    for (int x = 0; x < truth.columns; ++x) {
      const auto edge = [&](double at) { return 0.5 * std::erfc((at - x) / truth.blur_px / std::sqrt(2.0)); };
      const double part = edge(middle - truth.half_width) - edge(middle + truth.half_width);
      image(x, y) = static_cast<float>(noisy(truth.ground + truth.light * part, truth.noise, random));
    }
  }
  return image;
}

}  // namespace vam::oracle
