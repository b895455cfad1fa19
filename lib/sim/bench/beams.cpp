// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/bench/private/beams.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "base/index.hpp"
#include "base/stats/distributions.hpp"
#include "model/circle.hpp"

namespace vam::sim {

namespace {

constexpr int sheets = 512;
constexpr double reach = 4;  // standard deviations of a blur

// Part of a stretch from top to bottom, blurred, that a row gives: a box moved over a box, or a Gaussian over one.
double share(int row, double top, double bottom, double sigma) {
  if (sigma <= 0) return std::max(0.0, std::min(bottom, row + 0.5) - std::max(top, row - 0.5)) / (bottom - top);
  const double middle = 0.5 * (top + bottom);
  const double wide = std::hypot(sigma, (bottom - top) / std::sqrt(12.0));
  return stats::normal_integral((row + 0.5 - middle) / wide) - stats::normal_integral((row - 0.5 - middle) / wide);
}

std::vector<double> blurred(const std::vector<double>& light, double sigma) {
  const auto n = static_cast<std::ptrdiff_t>(light.size());
  const auto half = static_cast<std::ptrdiff_t>(std::ceil(reach * sigma));
  std::vector<double> kernel;
  double sum = 0;
  for (std::ptrdiff_t i = -half; i <= half; ++i) {
    kernel.push_back(stats::normal_integral((static_cast<double>(i) + 0.5) / sigma) -
                     stats::normal_integral((static_cast<double>(i) - 0.5) / sigma));
    sum += kernel.back();
  }
  std::vector<double> out(light.size());
  for (std::ptrdiff_t c = 0; c < n; ++c) {
    const double value = light[c] / sum;
    if (value == 0) continue;
    for (std::ptrdiff_t i = std::max(-half, -c); i <= std::min(half, n - 1 - c); ++i) {
      out[c + i] += value * kernel[i + half];
    }
  }
  return out;
}

}  // namespace

SimBeams::SimBeams(const model::Printer& printer)
    : pixel_mm_(printer.projector.pixel_mm),
      radius_mm_(model::resin_radius_mm(printer.vial)),
      absorption_per_mm_(printer.resin.absorption_per_mm) {
  const SimShells shells = outer_shells(printer, printer.resin.index);
  const auto lens_mm = model::columns_lens_mm(printer.projector);
  double grazing_mm = 0;
  double outside_mm = printer.vial.radius_mm;
  while (sim_ray(outside_mm, lens_mm, shells).enters) outside_mm *= 2;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (grazing_mm + outside_mm);
    (sim_ray(middle, lens_mm, shells).enters ? grazing_mm : outside_mm) = middle;
  }
  for (int i = 0; i <= sheets; ++i) {  // denser towards the edges, where they turn fast
    const double x_mm = -grazing_mm * std::cos(std::numbers::pi * i / sheets);
    columns_.push_back(printer.projector.axis_column + x_mm / pixel_mm_);
    rays_.push_back(sim_ray(x_mm, lens_mm, shells));
  }
}

std::vector<SimBeams::Crossing> SimBeams::along(const SimRay& sight, double azimuth_rad) const {
  std::vector<Crossing> crossings(rays_.size() - 1);
  if (!sight.enters) return crossings;
  const double turn = sight.turn_rad + azimuth_rad;
  const double half_mm = model::half_chord(radius_mm_, sight.offset_mm);
  const auto where_mm = [&](const SimRay& beam) {  // along the line of sight
    return (beam.offset_mm - sight.offset_mm * std::cos(turn - beam.turn_rad)) / std::sin(beam.turn_rad - turn);
  };
  double before_mm = where_mm(rays_.front());
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const SimRay& one = rays_[i];
    const SimRay& next = rays_[i + 1];
    const double after_mm = where_mm(next);
    const double first = std::min(before_mm, after_mm);
    const double last = std::max(before_mm, after_mm);
    before_mm = after_mm;
    const double from = std::max(first, -half_mm);
    const double to = std::min(last, half_mm);
    const double slant = std::sin(0.5 * (one.turn_rad + next.turn_rad) - turn);
    const bool parallel = std::sin(one.turn_rad - turn) * std::sin(next.turn_rad - turn) <= 0;
    if (parallel || !(to > from)) continue;
    // The sheet carries its light whatever its width is where it is crossed: irradiance x path = light / sin.
    const double light_mm =
        0.5 * (one.transmittance + next.transmittance) * (columns_[i + 1] - columns_[i]) * pixel_mm_;
    const double middle = 0.5 * (from + to);
    const double x_mm = sight.offset_mm * std::cos(turn) - middle * std::sin(turn);
    const double y_mm = sight.offset_mm * std::sin(turn) + middle * std::cos(turn);
    const double beam_rad = 0.5 * (one.turn_rad + next.turn_rad);
    const double come_mm = model::half_chord(radius_mm_, 0.5 * (one.offset_mm + next.offset_mm)) -
                           x_mm * std::sin(beam_rad) + y_mm * std::cos(beam_rad);  // in the resin
    const double left = std::exp(-absorption_per_mm_ * std::max(0.0, come_mm));
    crossings[i] = {left * light_mm / std::abs(slant) * (to - from) / (last - first), y_mm};
  }
  return crossings;
}

LitRow::LitRow(const std::vector<double>& light) : sum_(light.size() + 1) {
  for (std::size_t i = 0; i < light.size(); ++i) sum_[i + 1] = sum_[i] + light[i];
}

double LitRow::upto(double column) const {
  const double at = std::clamp(column + 0.5, 0.0, static_cast<double>(sum_.size() - 1));
  const auto below = std::min(static_cast<std::size_t>(at), sum_.size() - 2);
  return sum_[below] + (at - static_cast<double>(below)) * (sum_[below + 1] - sum_[below]);
}

double LitRow::mean(double from, double to) const {
  const double middle = 0.5 * (from + to);
  const double half = std::max(0.5 * std::abs(to - from), 1e-6);
  return (upto(middle + half) - upto(middle - half)) / (2 * half);
}

LitImage::LitImage(const GreyImage& image, double gamma) : image_(image), gamma_(gamma) {
  const auto width = static_cast<std::size_t>(image.width);
  for (int row = 0; row < image.height; ++row) {
    const auto* values = image.values.data() + product(row, width);
    const bool same = row > 0 && std::equal(values, values + width, values - width);
    twin_.push_back(same ? twin_.back() : row);
  }
}

double LitImage::light(int column, int row) const {
  const auto level = image_(column, row);
  if (level == 0) return 0;
  const double part = static_cast<double>(level) / image_.full();
  return gamma_ == 1 ? part : std::pow(part, gamma_);
}

int LitImage::uniform(double top, double bottom, double sigma_px) const {
  const double more = reach * sigma_px;
  const auto first = floor_int(top - more + 0.5);
  const auto last = floor_int(bottom + more + 0.5);
  if (last < 0 || first >= image_.height) return image_.height;  // all dark
  if (first < 0 || last >= image_.height) return -1;
  const int twin = twin_[first];
  return twin_[last] == twin ? twin : -1;
}

LitRow LitImage::between(double top, double bottom, double sigma_px) const {
  const double more = reach * sigma_px;
  std::vector<double> sum(image_.width);
  const auto last = std::min(floor_int(bottom + more + 0.5), image_.height - 1);
  for (int row = std::max(floor_int(top - more + 0.5), 0); row <= last; ++row) {
    const double part = share(row, top, bottom, sigma_px);
    for (int c = 0; c < image_.width; ++c) sum[c] += part * light(c, row);
  }
  return LitRow(sigma_px > 0 ? blurred(sum, sigma_px) : sum);
}

double LitImage::mean() const {
  double sum = 0;
  for (int row = 0; row < image_.height; ++row) {
    for (int c = 0; c < image_.width; ++c) sum += light(c, row);
  }
  return sum / static_cast<double>(std::max<std::size_t>(image_.values.size(), 1));
}

}  // namespace vam::sim
