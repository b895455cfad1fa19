// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/light.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#include "base/index.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/image/any_frames.hpp"
#include "model/metadata.hpp"
#include "plot/view.hpp"
#include "vam-report/page_parts.hpp"

namespace vam::report_tool {

namespace {

constexpr int most_pixels = 800;  // columns and slices of a projection
constexpr int shown_px = 400;
constexpr int most_sinograms = 9;

struct Columns {
  int first;
  int last;
};

/// From the first to the last that is lit in any image, with a margin; all where none is.
Columns lit_columns(const std::vector<Image>& images) {
  Columns lit{images[0].width - 1, 0};
  for (const Image& image : images) {
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (image(x, y) <= 0) continue;
        lit.first = std::min(lit.first, x);
        lit.last = std::max(lit.last, x);
      }
    }
  }
  if (lit.first > lit.last) return {0, images[0].width - 1};
  const int margin = 2 + (lit.last - lit.first) / 20;
  return {std::max(0, lit.first - margin), std::min(images[0].width - 1, lit.last + margin)};
}

/// Its columns first...last, resampled to this number of rows.
Image square(const Image& image, int first, int last, double rows) {
  Image made(last - first + 1, std::clamp(round_int(rows), 1, 4 * most_pixels));
  for (int y = 0; y < made.height; ++y) {
    const float* row = image.row(std::min(image.height - 1, y * image.height / made.height));
    std::copy(row + first, row + last + 1, made.row(y));
  }
  return made;
}

/// A sinogram turned into projections: one image an angle, thinned by means.
class Projections {
 public:
  Projections(const model::StackInfo& info, int count)
      : info_(info),
        by_column_((info.width + most_pixels - 1) / most_pixels),
        by_slice_((info.count + most_pixels - 1) / most_pixels) {
    const int shown = std::clamp(count, 1, info.height);
    for (int n = 0; n < shown; ++n) angles_.push_back(static_cast<int>(static_cast<long>(n) * info.height / shown));
    const int rows = (info.count + by_slice_ - 1) / by_slice_;
    images_.assign(angles_.size(), Image((info.width + by_column_ - 1) / by_column_, rows));
  }

  void add(const Image& sinogram, int slice) {
    const float share = 1.0F / static_cast<float>(by_column_ * by_slice_);
    for (std::size_t n = 0; n < angles_.size(); ++n) {
      Image& image = images_[n];
      const int row = image.height - 1 - slice / by_slice_;  // the highest slice at the top
      const float* line = sinogram.row(angles_[n]);
      for (int x = 0; x < sinogram.width; ++x) image(x / by_column_, row) += share * line[x];
    }
  }

  /// The columns that are lit at some angle, in square pixels; white from the value on that one of a thousand exceeds.
  [[nodiscard]] std::vector<Frame> frames() const {
    const auto [first, last] = lit_columns(images_);
    plot::ImageFigure figure;
    figure.scale.map = plot::ColourMap::grey;
    figure.scale.high = bright();
    figure.scale.label = "intensity (" + info_.units + ")";
    const double pixel_mm = by_column_ * info_.pixel_mm;
    const double left_mm = -0.5 * info_.width * info_.pixel_mm;
    const double low_mm = info_.z_start_mm - 0.5 * info_.row_mm;
    figure.x = {"column, from the middle (mm)", left_mm + first * pixel_mm, left_mm + (last + 1) * pixel_mm};
    figure.y = {"z (mm)", low_mm, low_mm + info_.count * info_.row_mm};
    figure.size = shown_px;
    const double rows = info_.count * info_.row_mm / pixel_mm;
    for (std::size_t n = 0; n < angles_.size(); ++n) {
      const double angle = info_.angle_start_deg + angles_[n] * info_.angle_step_deg;
      figure.panels.push_back(
          {square(images_[n], first, last, rows), "stage angle " + format_number(angle, 5) + " deg", {}});
    }
    return frames_of(figure);
  }

 private:
  [[nodiscard]] double bright() const {
    std::vector<float> lit;
    for (const Image& image : images_) {
      std::copy_if(image.values.begin(), image.values.end(), std::back_inserter(lit), [](float v) { return v > 0; });
    }
    if (lit.empty()) return 1;
    const auto at = lit.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(lit.size() - 1));
    std::nth_element(lit.begin(), at, lit.end());
    return static_cast<double>(*at);
  }

  model::StackInfo info_;
  int by_column_;
  int by_slice_;
  std::vector<int> angles_;  // rows of the sinograms
  std::vector<Image> images_;
};

std::string projections(const std::string& path, int count) {
  io::StackReader stack(path);
  Projections made(stack.info(), count);
  Image image;
  model::ImageInfo about;
  for (int slice = 0; stack.next(image, about); ++slice) made.add(image, slice);
  return series(
      "Projections", made.frames(),
      file_name(path) + ": one image per stage angle; white is the value that one pixel in a thousand exceeds.", true);
}

}  // namespace

std::string light_view(const std::string& path, io::FileType type, int count) {
  plot::ViewOptions options;
  options.name = file_name(path);
  options.size = shown_px;
  const auto images = io::open_images(path, type);
  const bool sinogram = images->info().kind == model::Kind::sinogram;
  options.stretch_z = model::stretch_z(images->info().extra);
  options.sheet = sinogram ? std::min(count, most_sinograms) : count;
  const std::string views = series(
      sinogram ? "Sinograms" : "Frames", frames_of(plot::view_images(*images, options)),
      file_name(path) + (sinogram ? ": columns to the right, stage angles downwards." : ": oriented as in the file."),
      !sinogram);
  return sinogram ? projections(path, count) + views : views;
}

}  // namespace vam::report_tool
