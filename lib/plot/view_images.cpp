// SPDX-License-Identifier: GPL-3.0-or-later
// Sinograms, frames and images.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "plot/private/view_parts.hpp"
#include "plot/view.hpp"

namespace vam::plot {

namespace {

using views::mm;

double angle_of(const model::StackInfo& info, const model::ImageInfo& about, int index) {
  return about.has_angle ? about.angle_deg : info.angle_start_deg + index * info.angle_step_deg;
}

/// Of a sinogram mm in the print.
double coordinate(const model::StackInfo& info, const model::ImageInfo& about, int index, double stretch_z) {
  return info.kind == model::Kind::sinogram ? about.z_mm / stretch_z : angle_of(info, about, index);
}

std::string caption_of(const model::StackInfo& info, const model::ImageInfo& about, int index, double stretch_z) {
  if (info.kind == model::Kind::sinogram) return "z = " + mm(about.z_mm / stretch_z);
  if (about.has_angle || info.angle_step_deg != 0) return format_number(angle_of(info, about, index), 5) + " deg";
  return about.has_time ? format_number(about.time_s, 5) + " s" : "frame " + std::to_string(index);
}

void set_axes(ImageFigure& figure, const model::StackInfo& info) {
  const bool sinogram = info.kind == model::Kind::sinogram;
  const double half = 0.5 * info.width * info.pixel_mm;
  figure.x = info.pixel_mm > 0 ? Axis{"column, from the middle (mm)", -half, half, false}
                               : Axis{"column", -0.5, info.width - 0.5, false};
  const double start = sinogram ? info.angle_start_deg : info.z_start_mm;
  const double step = sinogram ? info.angle_step_deg : info.row_mm;
  const char* label = sinogram ? "stage angle (deg)" : "z (mm)";
  // Row 0 is at the top, so the axis runs downwards with the rows.
  figure.y = step != 0 ? Axis{label, start + (info.height - 0.5) * step, start - 0.5 * step, false}
                       : Axis{"row", info.height - 0.5, -0.5, false};
  constexpr double turn_ticks_deg = 45;
  if (sinogram && std::abs(step) * info.height > 180) figure.y.step = turn_ticks_deg;
  figure.square_pixels = !sinogram;
}

struct Columns {
  int first;
  int last;
};

/// From the first to the last column with more than a thousandth of the largest value in any image; all where all are
/// 0.
Columns lit_columns(const std::vector<Panel>& panels) {
  float most = 0;
  for (const Panel& panel : panels) {
    for (const float value : panel.values.values) most = std::max(most, std::abs(value));
  }
  const int width = panels.front().values.width;
  Columns lit{width - 1, 0};
  for (const Panel& panel : panels) {
    for (int y = 0; y < panel.values.height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (std::abs(panel.values(x, y)) <= 1e-3F * most) continue;
        lit = {std::min(lit.first, x), std::max(lit.last, x)};
      }
    }
  }
  return lit.first <= lit.last ? lit : Columns{0, width - 1};
}

/// Cuts off the dark columns at both sides, but for a margin of a twentieth.
void crop(ImageFigure& figure) {
  const Image& shape = figure.panels.front().values;
  const Columns lit = lit_columns(figure.panels);
  const int margin = 1 + (lit.last - lit.first) / 20;
  const int first = std::max(0, lit.first - margin);
  views::crop(figure, {first, 0, std::min(shape.width - 1, lit.last + margin) - first + 1, shape.height});
}

// Keeps what is to be shown while the stack goes by.
class Selection {
 public:
  Selection(const model::StackInfo& info, const ViewOptions& options)
      : info_(info),
        at_(options.at),
        stretch_z_(options.stretch_z),
        indices_(views::spread(info.count, options.sheet)) {
    if (options.sheet <= 1 && info.kind == model::Kind::frames) indices_ = {0};
  }

  void offer(Image&& image, const model::ImageInfo& about, int index) {
    if (at_) {
      const double away = std::abs(coordinate(info_, about, index, stretch_z_) - *at_);
      if (index > 0 && away >= nearest_) return;
      nearest_ = away;
      panels = {{std::move(image), caption_of(info_, about, index, stretch_z_), {}}};
    } else if (std::find(indices_.begin(), indices_.end(), index) != indices_.end()) {
      panels.push_back({std::move(image), caption_of(info_, about, index, stretch_z_), {}});
    }
  }

  // How far the image shown is from the place wanted.
  [[nodiscard]] double away() const { return nearest_; }

  std::vector<Panel> panels;

 private:
  model::StackInfo info_;
  std::optional<double> at_;
  double stretch_z_;
  std::vector<int> indices_;
  double nearest_ = 0;
};

}  // namespace

ImageFigure view_images(io::ImageSource& images, const ViewOptions& options) {
  const model::StackInfo info = images.info();
  const bool sinogram = info.kind == model::Kind::sinogram;
  if (options.at && !sinogram && info.angle_step_deg == 0) {
    throw Error{Fault::data,
                options.name + ": its images have no recorded angles; show a sheet of them, or use the EXR stack"};
  }
  Selection selection(info, options);
  Image image;
  model::ImageInfo about;
  for (int index = 0; images.next(image, about); ++index) selection.offer(std::move(image), about, index);
  if (selection.panels.empty()) throw Error{Fault::data, options.name + ": has no image"};
  const double pitch = std::abs(sinogram ? info.row_mm / options.stretch_z : info.angle_step_deg);
  if (selection.away() > 0.51 * pitch + 1e-6) {
    throw Error{Fault::data, options.name + ": has no image at " + format_number(*options.at) + "; the nearest is " +
                                 selection.panels[0].caption};
  }
  ImageFigure figure;
  figure.panels = std::move(selection.panels);
  views::choose_colours(figure, options, sinogram ? views::Content::amount : views::Content::light);
  set_axes(figure, info);
  if (sinogram && options.crop) crop(figure);
  figure.scale.label = views::with_unit(sinogram ? "sinogram" : "intensity", info.units);
  figure.size = options.size;
  const std::string seen = options.name + (sinogram ? ": sinogram" : ": frame");
  figure.title = options.title.value_or(
      seen + (figure.panels.size() == 1 ? (sinogram ? " at " : ", ") + figure.panels[0].caption : "s"));
  return figure;
}

}  // namespace vam::plot
