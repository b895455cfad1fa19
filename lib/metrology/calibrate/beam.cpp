// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/beam.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/stats/distributions.hpp"
#include "base/text/text.hpp"
#include "metrology/calibrate/private/half_maximum.hpp"
#include "model/magnification.hpp"
#include "optics/chief_ray.hpp"

namespace vam::metrology {

namespace {

// A straight line between two samples stands for the flank of a line that is only a few pixels wide: up to 0.01 px at
// either crossing for a Gaussian flank of 1.5 px.
constexpr double interpolation_px = 0.015;

constexpr double middle_part = 0.8;  // of the resin's radius that is evaluated
constexpr int least_columns = 8;     // of a plane

// Full width at half maximum of the Gaussian that, summed over each sample, fits a bright peak on even ground.
stats::Measured gaussian_width(const std::vector<double>& profile, const std::string& subject) {
  const auto rough = half_maximum(profile);
  if (!rough) throw Error{Fault::data, subject + ": no bright line between two dark sides; light one row and focus"};
  enum : std::size_t { middle, sigma, light, ground };
  const auto residuals = [&](const std::vector<double>& p) {
    std::vector<double> out;
    for (std::size_t i = 0; i < profile.size(); ++i) {
      const double from = static_cast<double>(i) - 0.5 - p[middle];
      out.push_back(profile[i] - p[ground] -
                    p[light] *
                        (stats::normal_integral((from + 1) / p[sigma]) - stats::normal_integral(from / p[sigma])));
    }
    return out;
  };
  const double start_px = rough->width() / stats::fwhm_per_sigma;
  const double start_light = rough->height * rough->width();
  const auto fit = stats::fit_curve(residuals, {rough->middle(), start_px, start_light, profile.front()},
                                    {1e-3, 1e-3, 1e-4 * start_light, 1e-4 * rough->height}, subject);
  const stats::Measured width = fit.measured(sigma);
  return {std::abs(width.value) * stats::fwhm_per_sigma, width.sigma * stats::fwhm_per_sigma, width.n};
}

/// Columns of the resin's middle, in the light's direction or against it, and where along the light each looks.
struct MiddleColumns {
  std::vector<int> column;
  std::vector<double> plane_mm;
};

MiddleColumns middle_columns(const SideView& view, int width, const model::Printer& printer) {
  const optics::View rays = optics::camera_view(printer);
  const double along = std::sin(printer.camera.azimuth_deg * rad_per_deg) > 0 ? 1 : -1;
  const double radius_mm = optics::resin_radius_mm(rays);
  MiddleColumns middle;
  for (int c = 0; c < width; ++c) {
    const auto ray = optics::chief_ray(rays, (c - view.axis_column) * view.pixel_mm);
    if (!ray.hits || std::abs(ray.x_v_mm) > middle_part * radius_mm) continue;
    middle.column.push_back(c);
    middle.plane_mm.push_back(along * ray.x_v_mm * std::cos(ray.delta_rad));
  }
  return middle;
}

}  // namespace

stats::Measured line_width_px(const Image& image, const std::string& subject) {
  constexpr int groups = 8;
  if (image.height < 2 * groups) {
    throw Error{Fault::data, subject + ": " + std::to_string(image.height) + " rows; at least " +
                                 std::to_string(2 * groups) + " are needed"};
  }
  std::vector<double> widths;
  for (int g = 0; g < groups; ++g) {
    const auto extent = half_maximum(column_profile(image, g * image.height / groups, (g + 1) * image.height / groups));
    if (!extent) {
      throw Error{Fault::data, subject + ": no bright line between two dark sides; light one column and focus"};
    }
    widths.push_back(extent->width());
  }
  stats::Measured mean = stats::mean_of(widths);
  mean.sigma = std::hypot(mean.sigma, interpolation_px);
  return mean;
}

BeamWidths side_widths(const Image& image, const SideView& view, const model::Printer& printer, int planes) {
  if (std::abs(std::cos(printer.camera.azimuth_deg * rad_per_deg)) > std::sin(10 * rad_per_deg)) {
    throw Error{Fault::data, "beam: the camera is at " + format_number(printer.camera.azimuth_deg) +
                                 " degrees to the beam; planes are resolved only at 90 (camera.azimuth_deg)"};
  }
  const auto [inside, plane_mm] = middle_columns(view, image.width, printer);
  const int count = std::min(planes, count_of(inside) / least_columns);
  if (count < 4) {
    throw Error{Fault::data, "beam: the resin's middle is " + std::to_string(inside.size()) +
                                 " columns wide; at least " + std::to_string(4 * least_columns) +
                                 " are required; reduce the binning"};
  }
  const double row_mm = view.pixel_mm / model::camera_magnification(printer);
  BeamWidths widths;
  for (int p = 0; p < count; ++p) {
    const auto first = inside.size() * static_cast<std::size_t>(p) / static_cast<std::size_t>(count);
    const auto last = inside.size() * (static_cast<std::size_t>(p) + 1) / static_cast<std::size_t>(count);
    std::vector<double> profile(image.height);
    double sum_mm = 0;
    for (std::size_t i = first; i < last; ++i) {
      for (int r = 0; r < image.height; ++r) profile[r] += image(inside[i], r);
      sum_mm += plane_mm[i];
    }
    widths.plane_mm.push_back(sum_mm / static_cast<double>(last - first));
    const stats::Measured px = gaussian_width(profile, "plane at " + format_number(widths.plane_mm.back(), 3) + " mm");
    widths.fwhm_mm.push_back({px.value * row_mm, px.sigma * row_mm, px.n});
  }
  return widths;
}

namespace {

/// The largest growth of the width per distance from the narrowest plane.
double steepest_growth(const BeamWidths& widths, double focus_mm, double narrowest_mm) {
  double growth = 0;
  for (std::size_t i = 0; i < widths.plane_mm.size(); ++i) {
    const double away = std::abs(widths.plane_mm[i] - focus_mm);
    if (away > 0) growth = std::max(growth, (widths.fwhm_mm[i].value - narrowest_mm) / away);
  }
  return growth;
}

}  // namespace

MeasuredBeam measure_beam(const BeamWidths& widths) {
  const auto narrowest =
      std::min_element(widths.fwhm_mm.begin(), widths.fwhm_mm.end(),
                       [](const stats::Measured& a, const stats::Measured& b) { return a.value < b.value; });
  if (widths.fwhm_mm.size() < 4) {
    throw Error{Fault::data, "beam: " + std::to_string(widths.fwhm_mm.size()) +
                                 " planes; at least 4 are needed, some before and "
                                 "some behind the focus"};
  }
  enum : std::size_t { waist, focus, growth };
  const auto model_mm = [](const std::vector<double>& p, double y_mm) {
    return std::hypot(p[waist], p[growth] * (y_mm - p[focus]));
  };
  const auto residuals = [&](const std::vector<double>& p) {
    std::vector<double> out;
    for (std::size_t i = 0; i < widths.plane_mm.size(); ++i) {
      out.push_back((widths.fwhm_mm[i].value - model_mm(p, widths.plane_mm[i])) / widths.fwhm_mm[i].sigma);
    }
    return out;
  };
  const double focus_mm = widths.plane_mm[narrowest - widths.fwhm_mm.begin()];
  const double growth_start = steepest_growth(widths, focus_mm, narrowest->value);
  const double scale = narrowest->value;
  const auto fit =
      stats::fit_curve(residuals, {scale, focus_mm, std::max(growth_start, 1e-4)}, {1e-4 * scale, 1e-3, 1e-6},
                       "beam: widths of " + std::to_string(widths.plane_mm.size()) + " planes");
  MeasuredBeam beam{fit.measured(waist), fit.measured(focus), {}, fit.measured(growth)};
  beam.waist_mm.value = std::abs(beam.waist_mm.value);
  const double slope = std::abs(beam.divergence_deg.value);
  beam.divergence_deg.value = std::atan(slope) * deg_per_rad;
  beam.divergence_deg.sigma *= deg_per_rad / (1 + slope * slope);
  const auto& p = fit.value;
  const double width = model_mm(p, 0);
  beam.axis_fwhm_mm = fit.combined(
      {p[waist] / width, p[growth] * p[growth] * p[focus] / width, p[growth] * p[focus] * p[focus] / width});
  beam.axis_fwhm_mm.value = width;
  return beam;
}

}  // namespace vam::metrology
