// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/delivered.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/json.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "model/dose_metrics.hpp"
#include "model/grid_place.hpp"
#include "model/grid_size.hpp"

namespace vam::optimize_tool {

optimize::VolumeSource::Read delivered_dose(const Scene& scene, const Inputs& in, const Options& options) {
  if (in.delivered.empty()) return {};
  for (std::size_t i = 0; i < in.delivered.size(); ++i) {
    const model::Grid& grid = in.delivered[i].grid();
    if (model::same_voxels(grid, scene.grid)) continue;
    throw Error{Fault::data, options.delivered[i] + ": has " + model::place_text(grid) + ", but light reaches " +
                                 model::place_text(scene.grid) +
                                 "; compute it by vam-dose --like with this target and these settings"};
  }
  const auto critical = scene.printer.resin.critical_dose_mj_cm3;
  if (!critical) {
    throw Error{Fault::usage, "--delivered: the threshold of the resin is not known; set resin.critical_dose_mj_cm3"};
  }
  const auto relative = static_cast<float>(options.demands.window.threshold() / *critical);
  return [&doses = in.delivered, &scene, relative](int k, int count, float* to) {
    std::vector<float> dose(product(count, scene.grid.slice_size()));
    std::fill_n(to, dose.size(), 0.0F);
    for (const io::SparseVolume& one : doses) {
      one.read_slices(k, count, dose.data());
      for (std::size_t i = 0; i < dose.size(); ++i) to[i] += relative * dose[i];
    }
  };
}

void report_delivered(Json& report, const optimize::VolumeSource& source, const Scene& scene, const Options& options) {
  if (!source.delivered) return;
  const double threshold = options.demands.window.threshold();
  double part_dose = 0;
  std::int64_t part = 0, gelled = 0;
  std::vector<float> dose(scene.grid.slice_size()), target(dose.size());
  for (int k = 0; k < scene.grid.nz; ++k) {
    source.delivered(k, 1, dose.data());
    source.target(k, 1, target.data());
    for (std::size_t i = 0; i < dose.size(); ++i) {
      const model::Label label = model::label_of(target[i]);
      const auto received = static_cast<double>(dose[i]);
      if (label == model::Label::part) {
        part_dose += received;
        ++part;
      }
      if (label == model::Label::void_ && received >= threshold) ++gelled;
    }
  }
  const double percent = part > 0 ? 100 * part_dose / (static_cast<double>(part) * threshold) : 0;
  report["delivered"] = {{"part_mean_percent", percent}, {"void_gelled_voxels", gelled}};
  if (gelled == 0) return;
  warn(join(options.delivered, ", ") + ": " + std::to_string(gelled) +
       (gelled == 1 ? " voxel of the void has" : " voxels of the void have") +
       " received the critical dose already, which no light can undo; stop earlier, or with less light");
}

}  // namespace vam::optimize_tool
