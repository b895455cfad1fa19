// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/cure/threshold.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"

namespace vam::metrology {

namespace {

double sample(const Image& image, double x, double y) {
  const double cx = std::clamp(x, 0.0, image.width - 1.001);
  const double cy = std::clamp(y, 0.0, image.height - 1.001);
  const int i = static_cast<int>(cx);
  const int j = static_cast<int>(cy);
  const double fx = cx - i;
  const double fy = cy - j;
  const auto v = [&](int a, int b) { return image(a, b); };
  return (1 - fy) * ((1 - fx) * v(i, j) + fx * v(i + 1, j)) + fy * ((1 - fx) * v(i, j + 1) + fx * v(i + 1, j + 1));
}

// Hough's accumulator wants 8 bits; the least squares after it do not.
cv::Mat eight_bits(const Image& image) {
  const auto [low, high] = std::minmax_element(image.values.begin(), image.values.end());
  if (!(*high > *low)) throw Error{Fault::data, "no circle: the image is uniform"};
  cv::Mat grey(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      grey.at<unsigned char>(y, x) = static_cast<unsigned char>(255 * (image(x, y) - *low) / (*high - *low));
    }
  }
  cv::GaussianBlur(grey, grey, {5, 5}, 1.2);
  return grey;
}

struct RimPoint {
  double x, y;
};

// The steepest place of the profile along a radius, by a parabola through the largest difference.
bool edge_on_radius(const Image& image, const FittedCircle& c, double angle, double reach, RimPoint& edge) {
  constexpr double h = 0.5;
  std::vector<double> slope;
  const double begin = c.radius - reach;
  const int count = static_cast<int>(2 * reach / h);
  for (int i = 0; i < count; ++i) {
    const double r = begin + i * h;
    const auto at = [&](double radius) {
      return sample(image, c.x + radius * std::cos(angle), c.y + radius * std::sin(angle));
    };
    slope.push_back(std::abs(at(r + 1.5) - at(r - 1.5)));
  }
  const auto peak = static_cast<std::size_t>(std::max_element(slope.begin(), slope.end()) - slope.begin());
  if (peak == 0 || peak + 1 == slope.size()) return false;
  const double curve = slope[peak - 1] - 2 * slope[peak] + slope[peak + 1];
  const double shift = curve < 0 ? 0.5 * (slope[peak - 1] - slope[peak + 1]) / curve : 0.0;
  const double r = begin + (static_cast<double>(peak) + shift) * h;
  edge = {c.x + r * std::cos(angle), c.y + r * std::sin(angle)};
  return true;
}

// Kasa's linear least-squares circle: x^2 + y^2 = 2 a x + 2 b y + c.
FittedCircle fit(const std::vector<RimPoint>& points) {
  cv::Matx33d normal = cv::Matx33d::zeros();
  cv::Vec3d right(0, 0, 0);
  for (const RimPoint& p : points) {
    const cv::Vec3d row(2 * p.x, 2 * p.y, 1);
    normal += row * row.t();
    right += (p.x * p.x + p.y * p.y) * row;
  }
  const cv::Vec3d s = normal.solve(right, cv::DECOMP_CHOLESKY);
  FittedCircle circle{s[0], s[1], std::sqrt(std::max(0.0, s[2] + s[0] * s[0] + s[1] * s[1])), 0};
  for (const RimPoint& p : points) {
    const double d = std::hypot(p.x - circle.x, p.y - circle.y) - circle.radius;
    circle.sigma += d * d / static_cast<double>(points.size());
  }
  circle.sigma = std::sqrt(circle.sigma);
  return circle;
}

}  // namespace

FittedCircle find_circle(const Image& image) {
  constexpr int smallest_px = 4;
  const int largest = std::min(image.width, image.height) / 2;
  std::vector<cv::Vec3f> found;
  if (largest > smallest_px) {
    cv::HoughCircles(eight_bits(image), found, cv::HOUGH_GRADIENT, 1.5, std::max(image.width, image.height), 60, 15,
                     smallest_px, largest);
  }
  if (found.empty()) {
    throw Error{Fault::data, "no circle with a radius of " + std::to_string(smallest_px) + " to " +
                                 std::to_string(largest) + " px detected"};
  }
  FittedCircle circle{found[0][0], found[0][1], found[0][2], 0};
  for (int round = 0; round < 3; ++round) {
    std::vector<RimPoint> edges;
    const double reach = std::max(3.0, (round == 0 ? 0.3 : 0.15) * circle.radius);
    constexpr int radii = 360;
    for (int i = 0; i < radii; ++i) {
      RimPoint edge{};
      if (edge_on_radius(image, circle, 2 * std::numbers::pi * i / radii, reach, edge)) edges.push_back(edge);
    }
    if (edges.size() < radii / 4)
      throw Error{Fault::data, "circle edge found on only " + std::to_string(edges.size()) + " of 360 radii"};
    circle = fit(edges);
  }
  return circle;
}

OverheadMean overhead_mean(const model::Volume& scatter) {
  const model::Grid& g = scatter.grid;
  std::vector<double> held(g.nz);
  for (int k = 0; k < g.nz; ++k) held[k] = std::accumulate(scatter.slice(k), scatter.slice(k) + g.slice_size(), 0.0);
  const double half = 0.5 * *std::max_element(held.begin(), held.end());
  if (!(half > 0)) throw Error{Fault::data, "standard: the volume is empty"};
  const auto full = [half](double value) { return value >= half; };
  const auto first = static_cast<int>(std::find_if(held.begin(), held.end(), full) - held.begin());
  const auto last = g.nz - 1 - static_cast<int>(std::find_if(held.rbegin(), held.rend(), full) - held.rbegin());
  const int rim = (last - first + 1) / 10;
  OverheadMean result{Image(g.nx, g.ny), (last - first + 1) * g.voxel_mm};
  const float share = 1.0F / static_cast<float>(last - first + 1 - 2 * rim);
  for (int k = first + rim; k <= last - rim; ++k) {
    for (int j = 0; j < g.ny; ++j) {
      float* out = result.mean.row(g.ny - 1 - j);
      const float* in = scatter.slice(k) + std::ptrdiff_t{j} * g.nx;
      for (int i = 0; i < g.nx; ++i) out[i] += share * in[i];
    }
  }
  return result;
}

namespace {

// A standard that the volume cuts has no edge there, and its mean is not that of its rim.
void require_whole(const Image& overhead, const FittedCircle& circle, double pixel_mm) {
  constexpr double rim_px = 2;
  const double off = std::hypot(circle.x - 0.5 * (overhead.width - 1), circle.y - 0.5 * (overhead.height - 1));
  const double room = 0.5 * std::min(overhead.width, overhead.height) - rim_px;
  if (off + circle.radius <= room) return;
  throw Error{Fault::data, "standard: its circle of " + format_number(2 * circle.radius * pixel_mm, 4) + " mm, " +
                               format_number(off * pixel_mm, 3) +
                               " mm off the axis, is cut by the edge of the volume, " +
                               format_number(room * pixel_mm, 4) +
                               " mm from the axis; reconstruct a larger --radius or place the standard at the axis"};
}

// Of a circle beside the edge the mean is that of the background, or of the inside.
void require_size(double apparent_mm, double stated_mm) {
  constexpr double allowed = 0.05;
  if (std::abs(apparent_mm / stated_mm - 1) <= allowed) return;
  throw Error{Fault::data, "standard: appears " + format_number(apparent_mm, 4) + " mm in diameter, " +
                               format_number(stated_mm, 4) +
                               " mm are stated; check --diameter, camera.pixel_mm and the distance of the camera"};
}

}  // namespace

Threshold gelation_threshold(const Image& overhead_mean, double pixel_mm, double diameter_mm) {
  Threshold result;
  const FittedCircle seen = find_circle(overhead_mean);
  result.apparent_diameter_mm = 2 * seen.radius * pixel_mm;
  result.diameter_mm = diameter_mm;
  result.circle = seen;
  result.circle.radius = 0.5 * diameter_mm / pixel_mm;
  require_whole(overhead_mean, seen, pixel_mm);
  require_whole(overhead_mean, result.circle, pixel_mm);
  require_size(result.apparent_diameter_mm, diameter_mm);
  const int points = std::max(360, static_cast<int>(2 * std::numbers::pi * result.circle.radius * 2));
  double sum = 0;
  double square = 0;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * std::numbers::pi * i / points;
    const double value = sample(overhead_mean, seen.x + result.circle.radius * std::cos(angle),
                                seen.y + result.circle.radius * std::sin(angle));
    sum += value;
    square += value * value;
  }
  result.isovalue = sum / points;
  result.spread = std::sqrt(std::max(0.0, square / points - result.isovalue * result.isovalue));
  return result;
}

Json to_json(const Threshold& t) {
  return {
      {"isovalue", t.isovalue},
      {"spread", t.spread},
      {"diameter_mm", t.diameter_mm},
      {"apparent_diameter_mm", t.apparent_diameter_mm},
      {"circle_px", {{"x", t.circle.x}, {"y", t.circle.y}, {"radius", t.circle.radius}, {"sigma", t.circle.sigma}}}};
}

}  // namespace vam::metrology
