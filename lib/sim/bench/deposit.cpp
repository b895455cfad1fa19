// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/bench/private/deposit.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "sim/bench/private/beams.hpp"

namespace vam::sim {

namespace {

constexpr double apart = 0.5;  // of a voxel: rays from each other in the plane of the axis, and steps along them
constexpr double mm_per_cm = 10;

SimLens lens_of(const model::Projector& projector) {
  return {model::columns_lens_mm(projector), model::rows_lens_mm(projector)};
}

// Columns of the image from the axis, left and right edge.
double left_edge_mm(const model::Projector& p) { return -(p.axis_column + 0.5) * p.pixel_mm; }
double right_edge_mm(const model::Projector& p) { return (p.columns - 0.5 - p.axis_column) * p.pixel_mm; }

}  // namespace

double lit_radius_mm(const model::Printer& printer) {
  const SimShells shells = outer_shells(printer, printer.resin.index);
  const auto lens_mm = model::columns_lens_mm(printer.projector);
  const double left_mm = left_edge_mm(printer.projector);
  const double right_mm = right_edge_mm(printer.projector);
  constexpr int tried = 1000;
  double furthest_mm = 0;
  for (int i = 0; i <= tried; ++i) {
    const SimRay ray = sim_ray(left_mm + (right_mm - left_mm) * i / tried, lens_mm, shells);
    if (ray.enters) furthest_mm = std::max(furthest_mm, std::abs(ray.offset_mm));
  }
  return furthest_mm;
}

Deposit::Deposit(const model::Printer& printer, const model::Grid& grid, double gamma, double sigma_mm)
    : projector_(printer.projector),
      grid_(grid),
      absorption_per_mm_(printer.resin.absorption_per_mm),
      gamma_(gamma),
      sigma_px_(sigma_mm / printer.projector.pixel_mm),
      pitch_mm_(apart * grid.voxel_mm) {
  const SimShells shells = outer_shells(printer, printer.resin.index);
  const SimLens lens = lens_of(projector_);
  const double reach_mm =
      std::min(printer.vial.radius_mm, std::max(-left_edge_mm(projector_), right_edge_mm(projector_)));
  const int columns = 2 * ceil_int(reach_mm / pitch_mm_);
  left_mm_ = -0.5 * columns * pitch_mm_;
  const double top_mm = (projector_.axis_row + 0.5) * projector_.pixel_mm;
  const int rows = ceil_int(projector_.rows * projector_.pixel_mm / pitch_mm_);
  constexpr double golden = 0.6180339887;
  for (int j = 0; j < rows; ++j) {
    Row row{top_mm - j * pitch_mm_, top_mm - (j + 1) * pitch_mm_, {}};
    for (int i = 0; i < columns; ++i) {
      // Heights differ from ray to ray, or all would pass into the next slice at once.
      const double phase = golden * i - std::floor(golden * i);
      const double z_mm = row.bottom_mm + phase * pitch_mm_;
      row.rays.push_back(climbing_ray(left_mm_ + (i + 0.5) * pitch_mm_, z_mm, lens, shells));
    }
    rows_.push_back(std::move(row));
  }
}

void Deposit::leave(const ClimbingRay& ray, double phase, double dose, std::vector<float>& absorbed) const {
  const int low[3] = {0, 0, 0};
  const int high[3] = {grid_.nx, grid_.ny, grid_.nz};
  const RaySegment way = passage(ray, grid_, low, high);
  const double step_mm = apart * grid_.voxel_mm;
  const double first_mm = way.from_mm + phase * step_mm;
  const int steps = way.to_mm > first_mm ? ceil_int((way.to_mm - first_mm) / step_mm) : 0;
  const auto fade = static_cast<float>(std::exp(-absorption_per_mm_ * step_mm));
  auto left = static_cast<float>(dose * absorption_per_mm_ * step_mm * std::exp(-absorption_per_mm_ * first_mm));
  for (int n = 0; n < steps; ++n) {
    const auto s = static_cast<float>(first_mm + n * step_mm);
    const int i = std::min(static_cast<int>(std::max(way.at[0] + s * way.along[0], 0.0F)), grid_.nx - 1);
    const int j = std::min(static_cast<int>(std::max(way.at[1] + s * way.along[1], 0.0F)), grid_.ny - 1);
    const int k = std::min(static_cast<int>(std::max(way.at[2] + s * way.along[2], 0.0F)), grid_.nz - 1);
    absorbed[product(k, grid_.slice_size()) + flat_index(j, grid_.nx, i)] += left;
    left *= fade;
  }
}

void Deposit::add(const GreyImage& image, double part_rad, double right_px, double full_mw_cm2, double seconds,
                  std::vector<float>& absorbed) const {
  const LitImage light(image, gamma_);
  const double cosine = std::cos(part_rad);
  const double sine = std::sin(part_rad);
  const double volume_mm3 = grid_.voxel_mm * grid_.voxel_mm * grid_.voxel_mm;
  const double scale = full_mw_cm2 * seconds * mm_per_cm * pitch_mm_ * pitch_mm_ / volume_mm3;
  // The steps of neighbouring rays begin at phases that are spread by another irrational number than their heights are,
  // as the two must not go together; at angles that differ by parts of a degree they are unrelated.
  constexpr double silver = 0.4142135624;  // 2^(1/2) - 1
  constexpr double steps_per_rad = 1000;
  for (std::size_t j = 0; j < rows_.size(); ++j) {
    const Row& row = rows_[j];
    const double top = projector_.axis_row - row.top_mm / projector_.pixel_mm;
    const double bottom = projector_.axis_row - row.bottom_mm / projector_.pixel_mm;
    const LitRow lit = light.between(top, bottom, sigma_px_);
    for (std::size_t i = 0; i < row.rays.size(); ++i) {
      const double from =
          projector_.axis_column + right_px + (left_mm_ + static_cast<double>(i) * pitch_mm_) / projector_.pixel_mm;
      const double mean = lit.mean(from, from + pitch_mm_ / projector_.pixel_mm);
      constexpr double dark = 1e-9;
      if (mean < dark || !row.rays[i].enters) continue;
      const double place = silver * static_cast<double>(i + j) + steps_per_rad * part_rad;
      leave(turned(row.rays[i], cosine, sine), place - std::floor(place), mean * scale * row.rays[i].transmittance,
            absorbed);
    }
  }
}

}  // namespace vam::sim
