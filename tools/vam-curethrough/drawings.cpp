// SPDX-License-Identifier: GPL-3.0-or-later
// Figures after those of [CURE19].
#include <algorithm>
#include <array>
#include <cmath>

#include "base/text/text.hpp"
#include "plot/canvas.hpp"
#include "plot/plot.hpp"
#include "plot/save.hpp"
#include "vam-curethrough/figures.hpp"

namespace vam::curethrough {

namespace {

namespace paint = plot::paint;

constexpr Rgb cured{150, 150, 150};
constexpr Rgb red{214, 39, 40};
constexpr Rgb shade{235, 235, 235};

// Empty, correctly cured, cure-through (red), undercured (blue), as in [CURE19 fig 2c].
constexpr std::array<Rgb, 4> cure_colours{paint::white, cured, red, paint::blue};

RgbImage slices_image(const PlaneFigure& plane, const resin::Response& response) {
  RgbImage image(plane.light.width, plane.light.height);
  for (std::size_t p = 0; p < plane.light.size(); ++p) {
    const auto level =
        static_cast<std::uint8_t>(std::lround(255 * std::clamp(response.grey(plane.light.values[p]), 0.0, 1.0)));
    image.values[p] = {level, level, level};
  }
  return image;
}

RgbImage cure_image(const PlaneFigure& plane) {
  RgbImage image(plane.cure.width, plane.cure.height);
  for (std::size_t p = 0; p < plane.cure.size(); ++p) {
    image.values[p] = cure_colours[static_cast<std::size_t>(plane.cure.values[p])];
  }
  return image;
}

void draw_image(plot::Canvas& canvas, const plot::PlotFrame& frame, const RgbImage& image, const std::string& title) {
  canvas.paste(image, {frame.left, frame.top}, {frame.right, frame.bottom});
  plot::draw_axes(canvas, frame, false);
  canvas.text({frame.left, frame.top - 14}, title, plot::label_size);
}

// Grey and dose along the column over a shade where the part is, slice number down.
void draw_column(plot::Canvas& canvas, plot::PlotFrame frame, const PlaneFigure& plane, const PrintSettings& print) {
  const int slices = plane.light.height;
  const double peak = *std::max_element(plane.omega.begin(), plane.omega.end());
  frame.x = {"dose / full-cure dose", 0, std::max(1.5, std::ceil(2.2 * peak) / 2)};
  std::vector<plot::Spot> dose;
  std::vector<plot::Spot> stairs;
  for (int n = 0; n < slices; ++n) {
    if (plane.solid(plane.column, n) > 0) {
      canvas.fill(frame.spot(0, n), frame.spot(frame.x.high, n + 1.0), shade);
    }
    dose.push_back(frame.spot(plane.omega[n], n + 0.5));
    const double grey = print.response.grey(plane.light(plane.column, n));
    const double at = frame.left + 0.98 * grey * (frame.right - frame.left);
    stairs.push_back({at, frame.spot_y(n)});
    stairs.push_back({at, frame.spot_y(n + 1.0)});
  }
  plot::draw_axes(canvas, frame, false);
  canvas.dashed(frame.spot(1, 0), frame.spot(1, slices), paint::grey);
  canvas.polyline(stairs, paint::blue, 1.5);
  canvas.polyline(dose, red, 2);
  canvas.text({frame.left, frame.top - 14}, "column " + std::to_string(plane.column), plot::label_size);
  canvas.text({frame.right - 85, frame.top - 14}, "dose", plot::label_size, red, plot::Align::end);
  canvas.text({frame.right, frame.top - 14}, "grey 0..1", plot::label_size, paint::blue, plot::Align::end);
}

}  // namespace

void draw_plane(const std::string& path, const PlaneFigure& plane, const PrintSettings& print) {
  const int height = std::clamp(plane.light.height * 4, 280, 900);
  const double aspect = static_cast<double>(plane.light.width) / plane.light.height;  // voxels are cubes
  const int width = std::clamp(static_cast<int>(std::lround(height * aspect)), 200, 700);
  constexpr int left = 80;
  constexpr int top = 40;
  constexpr int curve = 300;
  plot::Canvas canvas(3 * left + 2 * width + curve + 20, top + height + 90);
  const plot::Axis x{"x (pixels)", 0, static_cast<double>(plane.light.width)};
  const plot::Axis y{"slice n: platform above, window below", static_cast<double>(plane.light.height), 0};
  const auto frame = [&](int number, int across, const plot::Axis& up) {
    const double start = left + number * (width + left);
    return plot::PlotFrame{start, top, start + across, static_cast<double>(top + height), x, up};
  };
  draw_image(canvas, frame(0, width, y), slices_image(plane, print.response),
             "slices, row " + std::to_string(plane.row));
  draw_image(canvas, frame(1, width, {"", y.low, y.high}), cure_image(plane), "cured");
  draw_column(canvas, frame(2, curve, {"", y.low, y.high}), plane, print);
  double at = 2.0 * left + width;
  for (const auto& [words, colour] :
       {std::pair{"correct", paint::grey}, {"cure-through", red}, {"undercured", paint::blue}}) {
    canvas.text({at, top + height + 74.0}, words, plot::label_size, colour);
    at += plot::Canvas::text_width(words, plot::label_size) + 20;
  }
  plot::save(path, canvas);
}

void draw_study(const std::string& path, const std::vector<resin::StudyPoint>& points, double slice_um) {
  constexpr std::array<Rgb, 8> colours{paint::black,     paint::blue, paint::orange,      paint::green,
                                       paint::vermilion, paint::grey, Rgb{204, 121, 167}, Rgb{86, 180, 233}};
  // The first omega_max of the study, a curve for each size of feature.
  const double first = points.front().omega_max;
  std::vector<double> factors;
  std::vector<std::vector<double>> ratios;
  std::vector<int> heights;
  double most = 1;
  for (const resin::StudyPoint& point : points) {
    if (point.omega_max != first || !point.printable) continue;
    factors.push_back(point.dose_factor);
    ratios.resize(point.sizes.size());
    heights.resize(point.sizes.size());
    for (std::size_t s = 0; s < point.sizes.size(); ++s) {
      heights[s] = point.sizes[s].height;
      ratios[s].push_back(point.sizes[s].ratio());
      most = std::max(most, std::min(3.0, point.sizes[s].ratio()));
    }
  }
  if (factors.empty()) factors = {0, 1};
  const double margin = std::max(0.5, 0.05 * (factors.back() - factors.front()));
  plot::Plot plot;
  plot.title = "omega_max = " + format_number(first);
  plot.x = {"assumed full-cure dose / gelation threshold", factors.front() - margin, factors.back() + margin};
  plot.y = {"height error, corrected / uncorrected", 0, 1.1 * most};
  for (std::size_t s = 0; s < ratios.size(); ++s) {
    const Rgb colour = colours[s % colours.size()];
    plot.series.push_back({format_number(heights[s] * slice_um) + " µm", factors, ratios[s], colour, {}});
    plot.series.push_back({"", factors, ratios[s], colour, plot::SeriesStyle::points});
  }
  plot::save(path, plot::draw(plot));
}

}  // namespace vam::curethrough
