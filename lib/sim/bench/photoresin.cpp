// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/bench/photoresin.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/index.hpp"

namespace vam::sim {

namespace {

constexpr double competition = 0.03;     // inhibitor left, of the mean, that takes half of the radicals
constexpr double least_scatter = 0.002;  // less is liquid
constexpr double stable = 0.15;          // of an explicit step of diffusion, in squares of a voxel

double rise(double conversion, double middle, double width) {
  return 1 / (1 + std::exp((middle - conversion) / width));
}

}  // namespace

Photoresin::Photoresin(const SimResin& about, const model::Grid& grid)
    : about_(about),
      grid_(grid),
      inhibition_mj_cm3_(about.induction * about.critical_dose_mj_cm3),
      growth_mj_cm3_((1 - about.induction) * about.critical_dose_mj_cm3 / -std::log(1 - about.gel_conversion)),
      absorbed_(grid.size()),
      inhibitor_(grid.size()),
      radicals_(grid.size()),
      conversion_(grid.size()),
      scratch_(grid.size()),
      scatter_{grid, std::vector<float>(grid.size())},
      lit_(grid.nz),
      scattering_{{grid.nx, grid.ny, grid.nz}, {0, 0, 0}} {
  for (int k = 0; k < grid.nz; ++k) {
    const double height = grid.nz > 1 ? k / (grid.nz - 1.0) - 0.5 : 0;
    const auto first = inhibitor_.begin() + static_cast<std::ptrdiff_t>(product(k, grid.slice_size()));
    std::fill_n(first, grid.slice_size(), static_cast<float>(1 + about.inhibition_gradient * height));
  }
}

double Photoresin::scatter_of(double conversion) const {
  const double none = rise(0, about_.gel_conversion, about_.scatter_width);
  const double all = rise(1, about_.gel_conversion, about_.scatter_width);
  return (rise(conversion, about_.gel_conversion, about_.scatter_width) - none) / (all - none);
}

void Photoresin::widen(std::size_t voxel) {
  const auto nx = static_cast<std::size_t>(grid_.nx);
  const auto ny = static_cast<std::size_t>(grid_.ny);
  const int at[3] = {static_cast<int>(voxel % nx), static_cast<int>(voxel / nx % ny),
                     static_cast<int>(voxel / nx / ny)};
  for (int axis = 0; axis < 3; ++axis) {
    scattering_.low[axis] = std::min(scattering_.low[axis], at[axis]);
    scattering_.high[axis] = std::max(scattering_.high[axis], at[axis] + 1);
  }
}

// The inhibitor takes radicals first, the rest lives for delay_s and converts what is left.
void Photoresin::react_slice(int k, double seconds) {
  const double share = about_.delay_s > 0 ? -std::expm1(-seconds / about_.delay_s) : 1;
  const std::size_t first = product(k, grid_.slice_size());
  for (std::size_t v = first; v < first + grid_.slice_size(); ++v) {
    const double dose = static_cast<double>(absorbed_[v]);
    if (dose == 0 && radicals_[v] == 0) continue;
    double left = dose;
    if (inhibitor_[v] > 0 && inhibition_mj_cm3_ > 0) {
      const double there = static_cast<double>(inhibitor_[v]);
      const double used = std::min(there, dose / inhibition_mj_cm3_ * there / (there + competition));
      inhibitor_[v] = static_cast<float>(there - used);
      left -= used * inhibition_mj_cm3_;
    }
    absorbed_[v] = 0;
    const double radicals = static_cast<double>(radicals_[v]) + left;
    const double spent = share * radicals;
    radicals_[v] = static_cast<float>(radicals - spent);
    const double before = static_cast<double>(conversion_[v]);
    const double after = before - (1 - before) * std::expm1(-spent / growth_mj_cm3_);
    conversion_[v] = static_cast<float>(after);
    const double scatter = scatter_of(after);
    if (scatter < least_scatter) continue;
    scatter_.values[v] = static_cast<float>(scatter);
    widen(v);
  }
}

// spread: coefficient x time over the square of a voxel. Nothing passes the faces of the grid and dark slices.
void Photoresin::diffuse(std::vector<float>& field, double spread) {
  if (!(spread > 0)) return;
  const int steps = ceil_int(spread / stable);
  const auto part = static_cast<float>(spread / steps);
  const std::size_t slice = grid_.slice_size();
  for (int step = 0; step < steps; ++step) {
    for (int k = 0; k < grid_.nz; ++k) {
      if (lit_[k] == 0) continue;
      const bool below = k > 0 && lit_[k - 1] != 0;
      const bool above = k + 1 < grid_.nz && lit_[k + 1] != 0;
      for (int j = 0; j < grid_.ny; ++j) {
        const float* at = field.data() + product(k, slice) + flat_index(j, grid_.nx, 0);
        float* out = scratch_.data() + product(k, slice) + flat_index(j, grid_.nx, 0);
        const float* low = below ? at - slice : at;
        const float* high = above ? at + slice : at;
        const float* before = j > 0 ? at - grid_.nx : at;
        const float* after = j + 1 < grid_.ny ? at + grid_.nx : at;
        for (int i = 0; i < grid_.nx; ++i) {
          const float left = at[std::max(0, i - 1)];
          const float right = at[std::min(grid_.nx - 1, i + 1)];
          out[i] = at[i] + part * (left + right + before[i] + after[i] + low[i] + high[i] - 6 * at[i]);
        }
      }
    }
    for (int k = 0; k < grid_.nz; ++k) {
      if (lit_[k] == 0) continue;
      const auto first = static_cast<std::ptrdiff_t>(product(k, slice));
      std::copy_n(scratch_.begin() + first, slice, field.begin() + first);
    }
  }
}

void Photoresin::react(double seconds) {
  for (int k = 0; k < grid_.nz; ++k) {
    const auto first = absorbed_.begin() + static_cast<std::ptrdiff_t>(product(k, grid_.slice_size()));
    if (lit_[k] == 0 && std::all_of(first, first + static_cast<std::ptrdiff_t>(grid_.slice_size()),
                                    [](float dose) { return dose == 0; })) {
      continue;
    }
    lit_[k] = 1;
    react_slice(k, seconds);
  }
  const double spread_per_mm2 = seconds / (grid_.voxel_mm * grid_.voxel_mm);
  diffuse(inhibitor_, about_.inhibitor_diffusion_mm2_s * spread_per_mm2);
  diffuse(radicals_, about_.dose_diffusion_mm2_s * spread_per_mm2);
}

model::Volume Photoresin::conversion() const {
  model::Volume relative{grid_, conversion_};
  for (float& value : relative.values) value /= static_cast<float>(about_.gel_conversion);
  return relative;
}

}  // namespace vam::sim
