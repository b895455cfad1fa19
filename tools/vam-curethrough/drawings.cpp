// The pictures, after the figures of [CURE19].
#include <algorithm>
#include <array>
#include <cmath>

#include "base/log.hpp"
#include "io/chart.hpp"
#include "io/picture.hpp"
#include "resin/student.hpp"
#include "vam-curethrough/figures.hpp"

namespace vam::curethrough {

namespace {

constexpr Rgb white{255, 255, 255};
constexpr Rgb black{0, 0, 0};
constexpr Rgb grey{150, 150, 150};
constexpr Rgb red{214, 39, 40};
constexpr Rgb blue{31, 90, 180};
constexpr Rgb pale{235, 235, 235};
constexpr Rgb pale_blue{212, 226, 245};

// Empty, correctly cured, cure-through (red), undercured (blue), as in [CURE19 fig 2c].
constexpr std::array<Rgb, 4> cure_colours{white, grey, red, blue};

std::vector<double> sequence(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / (count - 1));
  return values;
}

RgbImage slices_picture(const Plane& plane, const resin::Response& response) {
  RgbImage picture(plane.light.width, plane.light.height);
  for (std::size_t p = 0; p < plane.light.size(); ++p) {
    const auto level = static_cast<std::uint8_t>(
        std::lround(255 * std::clamp(response.grey(static_cast<double>(plane.light.values[p])), 0.0, 1.0)));
    picture.values[p] = {level, level, level};
  }
  return picture;
}

RgbImage cure_picture(const Plane& plane) {
  RgbImage picture(plane.cure.width, plane.cure.height);
  for (std::size_t p = 0; p < plane.cure.size(); ++p) {
    picture.values[p] = cure_colours[static_cast<std::size_t>(plane.cure.values[p])];
  }
  return picture;
}

// Grey and dose along the column over a shade where the part is, slice number down.
void draw_column(RgbImage& canvas, const io::ChartBox& box, const Plane& plane, const Print& print) {
  const int slices = plane.light.height;
  const double peak = *std::max_element(plane.omega.begin(), plane.omega.end());
  const double right = std::max(1.5, std::ceil(1.1 * peak * 2) / 2);
  std::vector<double> depth;
  std::vector<double> level;
  std::vector<double> stairs;
  RgbImage shade(1, slices, white);
  for (int n = 0; n < slices; ++n) {
    depth.push_back(n + 0.5);
    const double value = print.response.grey(static_cast<double>(plane.light(plane.column, n))) * right;
    level.insert(level.end(), {value, value});
    stairs.insert(stairs.end(), {static_cast<double>(n), n + 1.0});
    if (plane.solid(plane.column, n) > 0) shade(0, n) = pale;
  }
  const io::ChartAxis x{"dose / critical dose", 0, right};
  const io::ChartAxis y{"slice n", static_cast<double>(slices), 0};
  io::Chart(canvas, box, x, y, "").picture(shade);
  io::Chart chart(canvas, box, x, y, "column " + std::to_string(plane.column));
  chart.line(level, stairs, blue, 1);
  const std::vector<double> one{1, 1};
  const std::vector<double> ends{0, static_cast<double>(slices)};
  chart.line(one, ends, grey, 1);
  chart.line(plane.omega, depth, red, 2);
  chart.legend("grey, 0 to 1", blue);
  chart.legend("dose", red);
}

}  // namespace

void draw_plane(const std::string& path, const Plane& plane, const Print& print) {
  const int height = std::clamp(plane.light.height * 4, 240, 900);
  const double aspect = static_cast<double>(plane.light.width) / plane.light.height;  // voxels are cubes
  const int width = std::clamp(static_cast<int>(std::lround(height * aspect)), 120, 700);
  RgbImage canvas(width * 2 + 3 * 75 + 260 + 20, height + 90, white);
  const io::ChartAxis x{"x, pixels", 0, static_cast<double>(plane.light.width)};
  const io::ChartAxis y{"slice n (platform above, window below)", static_cast<double>(plane.light.height), 0};
  io::Chart slices(canvas, {70, 35, width, height}, x, y, "slices, row " + std::to_string(plane.row));
  slices.picture(slices_picture(plane, print.response));
  io::Chart cure(canvas, {70 + width + 75, 35, width, height}, x, {"", y.low, 0}, "cured");
  cure.picture(cure_picture(plane));
  draw_column(canvas, {70 + 2 * (width + 75), 35, 260, height}, plane, print);
  const int below = height + 85;
  const int left = 70 + width + 75;
  io::draw_text(canvas, left, below, "correct", {110, 110, 110});
  io::draw_text(canvas, left + 60, below, "cure-through", red);
  io::draw_text(canvas, left + 160, below, "undercured", blue);
  io::write_png(path, canvas);
}

void draw_working_curve(const std::string& path, const std::vector<resin::CuredSample>& samples,
                        const resin::WorkingCurve& curve) {
  std::array<std::vector<double>, 2> x;  // kept, flagged
  std::array<std::vector<double>, 2> y;
  double most = 0;
  double highest = 0;
  double mean = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    x[curve.outlier[i]].push_back(samples[i].exposure_mj_cm2);
    y[curve.outlier[i]].push_back(samples[i].thickness_um);
    most = std::max(most, samples[i].exposure_mj_cm2);
    highest = std::max(highest, samples[i].thickness_um);
    mean += std::log10(samples[i].exposure_mj_cm2) / static_cast<double>(samples.size());
  }
  double spread = 0;
  for (const auto& sample : samples) spread += std::pow(std::log10(sample.exposure_mj_cm2) - mean, 2);
  const double count = curve.samples;
  const double t = resin::student_quantile(1 - curve.confidence, count - 2);
  std::vector<double> at;
  std::vector<double> line;
  std::vector<double> low;
  std::vector<double> high;
  for (const double power : sequence(std::log10(0.8 * curve.critical_exposure_mj_cm2), std::log10(1.3 * most), 200)) {
    const double value = curve.absorbance_height_um * (power - std::log10(curve.critical_exposure_mj_cm2));
    const double error = t * curve.residual_sd_um * std::sqrt(1 / count + std::pow(power - mean, 2) / spread);
    at.push_back(std::pow(10, power));
    line.push_back(value);
    low.push_back(value - error);
    high.push_back(value + error);
  }
  RgbImage canvas(640, 460, white);
  const io::ChartAxis across{"exposure E, mJ/cm2 (log10)", at.front(), at.back(), true};
  const io::ChartAxis up{"cured thickness, um", 0, 1.12 * highest};
  const std::string title = "h_a = " + format_number(curve.absorbance_height_um, 4) +
                            " um per decade,  D_gel = " + format_number(curve.gel_dose_mj_cm3, 4) + " mJ/cm3";
  io::Chart chart(canvas, {80, 40, 530, 360}, across, up, title);
  chart.band(at, low, high, pale_blue);
  chart.line(at, line, blue);
  chart.dots(x[0], y[0], black);
  chart.dots(x[1], y[1], red);
  if (!x[1].empty()) chart.legend("outliers, kept in the fit", red);
  io::write_png(path, canvas);
}

void draw_response(const std::string& path, const model::ResponseTable& table) {
  const resin::Response response(table);
  const double full = table.grey.back();
  const double light = table.intensity.back();
  const std::vector<double> at = sequence(0, full, 300);
  std::vector<double> curve;
  for (const double g : at) curve.push_back(response.intensity(g / full) * light);
  RgbImage canvas(560, 460, white);
  io::Chart chart(canvas, {80, 40, 450, 360}, {"grey", 0, full}, {"intensity", 0, 1.05 * light}, "grey response");
  chart.line(at, curve, blue);
  chart.dots(table.grey, table.intensity, black);
  io::write_png(path, canvas);
}

void draw_study(const std::string& path, const std::vector<resin::StudyPoint>& points, double slice_um) {
  constexpr std::array<Rgb, 8> colours{{{0, 0, 0},
                                        {31, 90, 180},
                                        {214, 39, 40},
                                        {44, 160, 44},
                                        {230, 130, 20},
                                        {130, 80, 180},
                                        {0, 150, 160},
                                        {140, 90, 60}}};
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
  RgbImage canvas(660, 460, white);
  const double margin = std::max(0.5, 0.05 * (factors.back() - factors.front()));
  io::Chart chart(canvas, {80, 40, 550, 360},
                  {"assumed critical dose / gelation dose", factors.front() - margin, factors.back() + margin},
                  {"height error, corrected / uncorrected", 0, 1.1 * most}, "omega_max = " + format_number(first));
  for (std::size_t s = 0; s < ratios.size(); ++s) {
    const Rgb colour = colours[s % colours.size()];
    chart.line(factors, ratios[s], colour);
    chart.dots(factors, ratios[s], colour, 3);
    chart.legend(format_number(heights[s] * slice_um) + " um", colour);
  }
  io::write_png(path, canvas);
}

}  // namespace vam::curethrough
