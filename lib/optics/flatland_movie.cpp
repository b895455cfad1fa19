// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/flatland_movie.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "optics/private/refuse_negative.hpp"
#include "optics/private/sample_taps.hpp"

namespace vam::optics {

Image smear(std::span<const float> projection, double detector_mm, double angle_rad, const ImagePlane& canvas) {
  Image image(canvas.columns, canvas.rows);
  const int last = count_of(projection) - 1;
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
  std::vector<float> projection(sinogram.width, 0.0F);
  for (std::size_t k = 0; k < taps.weights.size(); ++k) {
    const int a = ((taps.first + static_cast<int>(k)) % sinogram.height + sinogram.height) % sinogram.height;
    const float* row = sinogram.row(a);
    for (std::size_t c = 0; c < projection.size(); ++c) projection[c] += taps.weights[k] * row[c];
  }
  return projection;
}

ImagePlane flatland_canvas(const model::Projector& projector, double column_offset, double row_offset) {
  return {projector.columns, projector.rows, projector.pixel_mm, 0.5 * (projector.columns - 1) + column_offset,
          0.5 * (projector.rows - 1) + row_offset};
}

FlatlandSlice::FlatlandSlice(std::string subject, const model::StackInfo& info, const ImagePlane& canvas, double z_mm)
    : subject_(std::move(subject)), info_(info), canvas_(canvas), wanted_mm_(z_mm) {}

void FlatlandSlice::add(const Image& sinogram, double z_mm) {
  const bool first = nearest_.values.empty();
  low_mm_ = first ? z_mm : std::min(low_mm_, z_mm);
  high_mm_ = first ? z_mm : std::max(high_mm_, z_mm);
  if (!first && std::abs(z_mm - wanted_mm_) >= std::abs(nearest_mm_ - wanted_mm_)) return;
  nearest_ = sinogram;
  nearest_mm_ = z_mm;
}

void FlatlandSlice::check() const {
  const std::string z = "z = " + format_number(wanted_mm_) + " mm";
  if (std::abs(nearest_mm_ - wanted_mm_) > 0.5 * info_.row_mm + 1e-6) {
    throw Error{Fault::data, subject_ + ": has no slice at " + z + "; its slices lie from " + format_number(low_mm_) +
                                 " to " + format_number(high_mm_) + " mm"};
  }
  if (*std::min_element(nearest_.values.begin(), nearest_.values.end()) < 0) {
    refuse_negative(subject_, nearest_, info_, nearest_mm_);
  }
  if (!(peak() > 0)) throw Error{Fault::data, subject_ + ": is dark at " + z + "; nothing to project"};
}

float FlatlandSlice::peak() const { return *std::max_element(nearest_.values.begin(), nearest_.values.end()); }

Image FlatlandSlice::frame(double angle_deg, double span_deg, const Image&) const {
  return smear(projection_at(nearest_, info_, angle_deg, span_deg), info_.pixel_mm, angle_deg * rad_per_deg, canvas_);
}

}  // namespace vam::optics
