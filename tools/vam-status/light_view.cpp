// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-status/light_view.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "io/exr/stack.hpp"
#include "model/grid.hpp"
#include "resin/absolute_dose.hpp"

namespace vam::status_tool {

namespace {

constexpr int kept = 300;    // columns, slices and stage angles that are kept
constexpr int across = 160;  // voxels of the dose over the resin

int stride(int count) { return (count + kept - 1) / kept; }

}  // namespace

LightView::LightView(const std::string& sinogram, const model::Printer& printer) : printer_(printer) {
  io::StackReader reader(sinogram);
  io::require(sinogram, reader.info(), model::Kind::sinogram, model::Space::projector);
  info_ = reader.info();
  info_.poses.clear();
  every_column_ = stride(info_.width);
  every_slice_ = stride(info_.count);
  every_row_ = stride(info_.height);
  Image image;
  model::ImageInfo about;
  for (int slice = 0; reader.next(image, about); ++slice) {
    for (float& value : image.values) value = std::max(0.0F, value);
    peak_ = std::max(peak_, *std::max_element(image.values.begin(), image.values.end()));
    if (slice % every_slice_ == 0) {
      Image thin((info_.width + every_column_ - 1) / every_column_, (info_.height + every_row_ - 1) / every_row_);
      for (int y = 0; y < thin.height; ++y) {
        for (int x = 0; x < thin.width; ++x) thin(x, y) = image(x * every_column_, y * every_row_);
      }
      thinned_.push_back(std::move(thin));
    }
    if (slice == middle_slice()) middle_ = std::move(image);
  }
  model::StackInfo one = info_;
  one.count = 1;
  one.z_start_mm = middle_mm();
  one.row_mm = 2 * resin_mm() / across;  // level rays know one slice only
  const model::Grid grid = model::centred_grid(across, across, 1, one.row_mm, middle_mm());
  simulation_ = std::make_unique<light::Simulation>(printer_, optics::AxisAlignment{}, one, grid, light::Climb::flat);
  const auto per_radian = resin::dose_per_radian_mj_cm3(printer);
  absolute_ = per_radian.has_value();
  if (absolute_ && peak_ > 0) per_unit_ = *per_radian / static_cast<double>(peak_);
  const Image turn = expose(std::vector<double>(info_.height, 1.0));
  full_dose_ = *std::max_element(turn.values.begin(), turn.values.end());
  if (absolute_ || full_dose_ <= 0) return;
  per_unit_ = 1 / full_dose_;
  full_dose_ = 1;
}

double LightView::resin_mm() const { return model::resin_radius_mm(printer_.vial); }

int LightView::row_of(double angle_deg) const {
  const long row = std::lround((angle_deg - info_.angle_start_deg) / info_.angle_step_deg) % info_.height;
  return static_cast<int>(row < 0 ? row + info_.height : row);
}

Image LightView::projection(double angle_deg) const {
  const int row = row_of(angle_deg) / every_row_;
  const auto slices = count_of(thinned_);
  const double half_mm = printer_.vial.radius_mm;
  const double pixel_mm = 2 * half_mm / kept;
  Image image(kept, std::max(1, round_int((high_mm() - low_mm()) / pixel_mm)));
  for (int y = 0; y < image.height; ++y) {
    const int slice = std::min(slices - 1, (image.height - 1 - y) * slices / image.height);
    const Image& rows = thinned_[slice];
    for (int x = 0; x < kept; ++x) {
      const double from_axis_mm = (x + 0.5) * pixel_mm - half_mm;
      const auto column = floor_int((from_axis_mm / info_.pixel_mm + 0.5 * info_.width) / every_column_);
      if (column >= 0 && column < rows.width && peak_ > 0) image(x, y) = rows(column, row) / peak_;
    }
  }
  return image;
}

std::vector<float> LightView::beam(double angle_deg) const {
  const float* row = middle_.row(row_of(angle_deg));
  std::vector<float> values(row, row + middle_.width);
  for (float& value : values) value = peak_ > 0 ? value / peak_ : 0;
  return values;
}

Image LightView::expose(const std::vector<double>& turns) const {
  Image light = middle_;
  for (int y = 0; y < light.height; ++y) {
    for (int x = 0; x < light.width; ++x) light(x, y) *= static_cast<float>(turns[y]);
  }
  Image dose;
  simulation_->dose({&light, 1}, {&dose, 1});
  Image up(dose.width, dose.height);
  for (int y = 0; y < up.height; ++y) {
    for (int x = 0; x < up.width; ++x) {
      up(x, y) = static_cast<float>(dose(x, up.height - 1 - y) * per_unit_);
    }
  }
  return up;
}

Image LightView::dose(const std::vector<io::ShownImage>& shown) const {
  const io::StageRows rows{info_.height, info_.angle_start_deg, info_.angle_step_deg};
  return expose(io::turns_shown(shown, rows, printer_.stage.speed_deg_s));
}

}  // namespace vam::status_tool
