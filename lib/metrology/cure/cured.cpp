// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/cure/cured.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/text/json.hpp"
#include "model/dose/dose_metrics.hpp"

namespace vam::metrology {

SumProjections sum_projections(const model::Volume& volume, std::optional<double> threshold) {
  const model::Grid& g = volume.grid;
  SumProjections sums{Image(g.ny, g.nz), Image(g.nx, g.nz), Image(g.nx, g.ny)};
  const auto mm = static_cast<float>(g.voxel_mm);
  for (int k = 0; k < g.nz; ++k) {
    const float* in = volume.slice(k);
    float* side_x = sums.along_x.row(g.nz - 1 - k);
    float* side_y = sums.along_y.row(g.nz - 1 - k);
    for (int j = 0; j < g.ny; ++j) {
      float* top = sums.along_z.row(g.ny - 1 - j);
      for (int i = 0; i < g.nx; ++i) {
        const float raw = in[j * g.nx + i];
        const float value = mm * (threshold ? (static_cast<double>(raw) >= *threshold ? 1.0F : 0.0F) : raw);
        side_x[j] += value;
        side_y[i] += value;
        top[i] += value;
      }
    }
  }
  return sums;
}

Cured cured(const model::Volume& scatter, double level, const model::StretchedVolume& target) {
  const std::vector<float>& coverage = target.volume.values;
  const auto whole = static_cast<double>(std::count_if(coverage.begin(), coverage.end(), model::half_covered));
  if (whole == 0) throw Error{Fault::data, "target: no voxel is covered by a half or more"};
  const model::Grid& g = scatter.grid;
  std::vector<std::array<long, 3>> counts(g.nz, {0, 0, 0});  // both, only print, only design
  parallel_for(g.nz, [&](int k) {
    auto& count = counts[k];
    const float* in = scatter.slice(k);
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        const bool print = static_cast<double>(in[j * g.nx + i]) >= level;
        const bool design = model::half_covered(target.at(g.x_mm(i), g.y_mm(j), g.z_mm(k)));
        count[0] += print && design ? 1 : 0;
        count[1] += print && !design ? 1 : 0;
        count[2] += !print && design ? 1 : 0;
      }
    }
  });
  std::array<double, 3> sums{};
  for (const auto& count : counts) {
    for (std::size_t d = 0; d < 3; ++d) sums[d] += static_cast<double>(count[d]);
  }
  const double voxel_mm3 = g.voxel_mm * g.voxel_mm * g.voxel_mm;
  const double design_mm3 = whole * std::pow(target.volume.grid.voxel_mm, 3) / target.stretch_z;
  const double outside_mm3 = design_mm3 - voxel_mm3 * (sums[0] + sums[2]);  // design that the camera does not see
  Cured state;
  state.target_mm3 = design_mm3;
  state.cured_mm3 = voxel_mm3 * (sums[0] + sums[1]);
  state.overcure_mm3 = voxel_mm3 * sums[1];
  state.missing_mm3 = voxel_mm3 * sums[2] + (outside_mm3 > 0.02 * design_mm3 ? outside_mm3 : 0.0);
  state.iou = sums[0] / (sums[0] + sums[1] + state.missing_mm3 / voxel_mm3);
  return state;
}

Json to_json(const Cured& state) {
  return {{"target_mm3", state.target_mm3},
          {"cured_mm3", state.cured_mm3},
          {"missing_mm3", state.missing_mm3},
          {"missing_percent", state.missing_percent()},
          {"overcure_mm3", state.overcure_mm3},
          {"overcure_percent", state.overcure_percent()},
          {"iou", state.iou}};
}

const std::vector<std::string>& cured_names() {
  static const std::vector<std::string> names{"missing", "overcure", "iou", "cured"};
  return names;
}

double figure(const Cured& state, const std::string& name) {
  if (name == "missing") return state.missing_percent();
  if (name == "overcure") return state.overcure_percent();
  if (name == "iou") return state.iou;
  return state.cured_mm3;
}

}  // namespace vam::metrology
