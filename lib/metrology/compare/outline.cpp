// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/private/outline.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace vam::metrology {

OutlinePoint image_middle(const Image& image) { return {0.5 * (image.width - 1), 0.5 * (image.height - 1)}; }

float bilinear(const Image& image, double column, double row) {
  const double x = std::clamp(column, 0.0, image.width - 1.001);
  const double y = std::clamp(row, 0.0, image.height - 1.001);
  const int i = static_cast<int>(x);
  const int j = static_cast<int>(y);
  const auto fx = static_cast<float>(x - i);
  const auto fy = static_cast<float>(y - j);
  return (1 - fy) * ((1 - fx) * image(i, j) + fx * image(i + 1, j)) +
         fy * ((1 - fx) * image(i, j + 1) + fx * image(i + 1, j + 1));
}

namespace {

cv::Mat matrix_of(Image& image) { return {image.height, image.width, CV_32F, image.values.data()}; }

// 1 where the outline may be judged.
Image judged(const Relief& print) {
  Image known = print.measured;
  const cv::Mat pixels = matrix_of(known);
  cv::Mat gaps = pixels == 0;
  cv::erode(gaps, gaps, cv::Mat::ones(5, 5, CV_8U), {-1, -1}, 1, cv::BORDER_REPLICATE);
  cv::dilate(gaps, gaps, cv::Mat::ones(13, 13, CV_8U), {-1, -1}, 1, cv::BORDER_REPLICATE);
  cv::threshold(gaps, gaps, 0, 1, cv::THRESH_BINARY_INV);
  gaps.convertTo(pixels, CV_32F);
  return known;
}

}  // namespace

Image distance_to(const Image& image, float level) {
  Image distance = image;
  const cv::Mat pixels = matrix_of(distance);
  const cv::Mat above = pixels >= level;
  cv::Mat inside;
  cv::Mat outside;
  cv::distanceTransform(above, inside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(~above, outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::subtract(outside, 0.5F, pixels);
  cv::Mat(0.5F - inside).copyTo(pixels, above);
  return distance;
}

Outline::Outline(const Relief& print)
    : distance_(distance_to(print.heights_mm, static_cast<float>(0.5 * print.plateau_mm))),
      judged_(judged(print)),
      pixel_mm_(print.pixel_mm),
      middle_(image_middle(distance_)) {}

double Outline::distance(const OutlinePoint& p) const {
  return pixel_mm_ * static_cast<double>(bilinear(distance_, middle_.x + p.x / pixel_mm_, middle_.y - p.y / pixel_mm_));
}

bool Outline::judges(const OutlinePoint& p) const {
  return bilinear(judged_, middle_.x + p.x / pixel_mm_, middle_.y - p.y / pixel_mm_) > 0.999F;
}

OutlinePoint Outline::gradient(const OutlinePoint& p) const {
  const double h = pixel_mm_;
  return {(distance({p.x + h, p.y}) - distance({p.x - h, p.y})) / (2 * h),
          (distance({p.x, p.y + h}) - distance({p.x, p.y - h})) / (2 * h)};
}

double Outline::rms(const std::vector<OutlinePoint>& points, const Similar& pose) const {
  double sum = 0;
  double count = 0;
  for (const OutlinePoint& p : points) {
    if (!judges(pose(p))) continue;
    sum += std::pow(distance(pose(p)), 2);
    count += 1;
  }
  return count > 0 ? std::sqrt(sum / count) : 1e300;
}

Similar fit_outline(const std::vector<OutlinePoint>& points, const Outline& outline, Similar pose, int steps) {
  double reach = 1e-9;
  for (const OutlinePoint& p : points) reach = std::max(reach, std::hypot(p.x, p.y));
  for (int step = 0; step < steps; ++step) {
    const double bound = 2.5 * outline.rms(points, pose) + 1e-9;
    cv::Matx44d normal = cv::Matx44d::zeros();
    cv::Vec4d right = cv::Vec4d::zeros();
    for (const OutlinePoint& p : points) {
      const OutlinePoint at = pose(p);
      if (!outline.judges(at)) continue;
      const double r = outline.distance(at);
      const OutlinePoint g = outline.gradient(at);
      const cv::Vec4d row((g.x * p.x + g.y * p.y) / reach, (g.y * p.x - g.x * p.y) / reach, g.x, g.y);
      const double weight = std::min(1.0, bound / (std::abs(r) + 1e-300));
      normal += weight * row * row.t();
      right -= weight * r * row;
    }
    for (int d = 0; d < 4; ++d) normal(d, d) += 1e-9 * normal(d, d) + 1e-12;  // a ring may turn freely
    const cv::Vec4d x = normal.solve(right, cv::DECOMP_CHOLESKY);
    pose.a += x[0] / reach;
    pose.b += x[1] / reach;
    pose.x += x[2];
    pose.y += x[3];
    if (std::abs(x[0]) + std::abs(x[1]) + std::abs(x[2]) + std::abs(x[3]) < 1e-6) break;
  }
  return pose;
}

}  // namespace vam::metrology
