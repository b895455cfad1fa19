#include "optics/flatland.hpp"

#include <algorithm>
#include <cmath>

#include "optics/taps.hpp"

namespace vam::optics {

Image smear(std::span<const float> projection, double detector_mm, double angle_rad, const Canvas& canvas) {
  Image image(canvas.columns, canvas.rows);
  const int last = static_cast<int>(projection.size()) - 1;
  const double scale = canvas.pixel_mm / detector_mm;
  const double step = scale * std::cos(angle_rad);
  for (int r = 0; r < canvas.rows; ++r) {
    float* row = image.row(r);
    const double of_row = 0.5 * last + scale * (canvas.axis_row - r) * std::sin(angle_rad) - step * canvas.axis_column;
    for (int c = 0; c < canvas.columns; ++c) {
      const double t = of_row + step * c;
      if (t < 0 || t > last) continue;
      const int below = std::min(static_cast<int>(t), last - 1);
      const auto part = static_cast<float>(t - below);
      const auto at = static_cast<std::size_t>(below);
      row[c] = (1 - part) * projection[at] + part * projection[at + 1];
    }
  }
  return image;
}

std::vector<float> projection_at(const Image& sinogram, const model::StackInfo& info, double angle_deg,
                                 double span_deg) {
  const Taps taps =
      sample_taps((angle_deg - info.angle_start_deg) / info.angle_step_deg, span_deg / std::abs(info.angle_step_deg));
  std::vector<float> projection(static_cast<std::size_t>(sinogram.width), 0.0F);
  for (std::size_t k = 0; k < taps.weights.size(); ++k) {
    const int a = ((taps.first + static_cast<int>(k)) % sinogram.height + sinogram.height) % sinogram.height;
    const float* row = sinogram.row(a);
    for (std::size_t c = 0; c < projection.size(); ++c) projection[c] += taps.weights[k] * row[c];
  }
  return projection;
}

}  // namespace vam::optics
