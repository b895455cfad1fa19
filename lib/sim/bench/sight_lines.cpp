// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/bench/private/sight_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/constants.hpp"
#include "base/index.hpp"

namespace vam::sim {

namespace {

constexpr double step_voxels = 0.75;

// Between the eight voxels around a place, in voxels from the lower corner; all of them are in the volume.
float between(const float* values, std::size_t row, std::size_t slice, float x, float y, float z) {
  const auto i = static_cast<std::size_t>(x);
  const auto j = static_cast<std::size_t>(y);
  const auto k = static_cast<std::size_t>(z);
  const float fx = x - static_cast<float>(i);
  const float fy = y - static_cast<float>(j);
  const float fz = z - static_cast<float>(k);
  const float* v = values + k * slice + j * row + i;
  const auto line = [fx](const float* a) { return a[0] + fx * (a[1] - a[0]); };
  const auto face = [&](const float* a) { return line(a) + fy * (line(a + row) - line(a)); };
  return face(v) + fz * (face(v + slice) - face(v));
}

// The sum of values times voxels along a passage.
double sum_along(const model::Volume& volume, const RaySegment& way) {
  const model::Grid& g = volume.grid;
  const double length = (way.to_mm - way.from_mm) / g.voxel_mm;
  if (!(length > 0)) return 0;
  const int steps = ceil_int(length / step_voxels);
  const auto step_mm = static_cast<float>((way.to_mm - way.from_mm) / steps);
  const auto first_mm = static_cast<float>(way.from_mm) + 0.5F * step_mm;
  const auto inside = [](float at, int count) {
    return std::clamp(at - 0.5F, 0.0F, static_cast<float>(count) - 1.001F);
  };
  double sum = 0;
  for (int n = 0; n < steps; ++n) {
    const float s = first_mm + static_cast<float>(n) * step_mm;
    sum += static_cast<double>(between(volume.values.data(), static_cast<std::size_t>(g.nx), g.slice_size(),
                                       inside(way.at[0] + s * way.along[0], g.nx),
                                       inside(way.at[1] + s * way.along[1], g.ny),
                                       inside(way.at[2] + s * way.along[2], g.nz)));
  }
  return sum * static_cast<double>(step_mm);
}

}  // namespace

SightLines::SightLines(const model::Printer& printer, int columns, int rows, double pixel_mm)
    : azimuth_rad_(printer.camera.azimuth_deg * rad_per_deg), columns_(columns), rows_(rows) {
  const SimShells shells = outer_shells(printer, printer.camera.index_resin);
  SimLens lens;
  if (!printer.camera.telecentric) lens = {printer.camera.distance_mm, printer.camera.distance_mm};
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      rays_.push_back(
          climbing_ray((c - 0.5 * (columns - 1)) * pixel_mm, (0.5 * (rows - 1) - r) * pixel_mm, lens, shells));
    }
  }
}

Image SightLines::view(const Photoresin& resin, double part_rad) const {
  Image image(columns_, rows_);
  const Photoresin::Box& box = resin.scattering();
  const model::Volume& scatter = resin.scatter();
  const int most[3] = {scatter.grid.nx, scatter.grid.ny, scatter.grid.nz};
  int low[3];
  int high[3];
  for (int a = 0; a < 3; ++a) {  // between voxels, so one further
    low[a] = std::max(0, box.low[a] - 1);
    high[a] = std::min(most[a], box.high[a] + 1);
    if (box.high[a] <= box.low[a]) return image;
  }
  const double cosine = std::cos(part_rad + azimuth_rad_);
  const double sine = std::sin(part_rad + azimuth_rad_);
  for (std::size_t p = 0; p < rays_.size(); ++p) {
    if (!rays_[p].enters) continue;
    const RaySegment way = passage(turned(rays_[p], cosine, sine), scatter.grid, low, high);
    image.values[p] = static_cast<float>(rays_[p].transmittance * sum_along(scatter, way));
  }
  return image;
}

}  // namespace vam::sim
