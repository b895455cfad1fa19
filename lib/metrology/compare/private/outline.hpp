// SPDX-License-Identifier: GPL-3.0-or-later
// Private to emboss: an outline of points laid onto another that is a field of distances. The middle of an image is
// (0, 0), x to the right, y up, in mm.
#pragma once

#include <vector>

#include "base/image.hpp"
#include "metrology/compare/emboss.hpp"

namespace vam::metrology {

struct OutlinePoint {
  double x = 0;
  double y = 0;
};

/// p -> (a p.x - b p.y + x, b p.x + a p.y + y): a similarity, linear in its unknowns.
struct Similar {
  double a = 1;
  double b = 0;
  double x = 0;
  double y = 0;
  OutlinePoint operator()(const OutlinePoint& p) const { return {a * p.x - b * p.y + x, b * p.x + a * p.y + y}; }
  [[nodiscard]] OutlinePoint inverse(const OutlinePoint& p) const {
    const double s = a * a + b * b;
    return {(a * (p.x - x) + b * (p.y - y)) / s, (-b * (p.x - x) + a * (p.y - y)) / s};
  }
};

/// In pixels.
[[nodiscard]] OutlinePoint image_middle(const Image& image);
/// The value between pixel middles; outside that of the nearest.
[[nodiscard]] float bilinear(const Image& image, double column, double row);

/// Signed distance in pixels to where the image crosses the level, positive below it. Between pixel middles a crossing
/// is taken half way; over an outline that is right in the mean.
[[nodiscard]] Image distance_to(const Image& image, float level);

/// The print's outline as a field of signed distances in mm.
class Outline {
 public:
  explicit Outline(const Relief& print);
  [[nodiscard]] double distance(const OutlinePoint& p) const;
  /// Not in gaps of five pixels and more, nor near them, where the print's outline is the end of the readings.
  [[nodiscard]] bool judges(const OutlinePoint& p) const;
  [[nodiscard]] OutlinePoint gradient(const OutlinePoint& p) const;
  /// Of the distances of the placed points that are judged; 1e300 when none is.
  [[nodiscard]] double rms(const std::vector<OutlinePoint>& points, const Similar& pose) const;

 private:
  Image distance_;
  Image judged_;
  double pixel_mm_;
  OutlinePoint middle_;
};

/// Gauss-Newton on the distances of the placed points; far ones pull with constant force (Huber).
[[nodiscard]] Similar fit_outline(const std::vector<OutlinePoint>& points, const Outline& outline, Similar pose,
                                  int steps);

}  // namespace vam::metrology
