// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/job_volumes.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/index.hpp"
#include "model/grid_place.hpp"
#include "model/grid_size.hpp"
#include "session/grey_target.hpp"
#include "session/volumes.hpp"

namespace vam::session {

JobVolumes read(const JobOptions& options) {
  const bool grey = options.demands.grey;
  std::vector<io::SparseVolume> grids =
      read_grids(options.input, grey ? io::TargetKind::grey : io::TargetKind::coverage);
  JobVolumes in;
  in.target.push_back(taken(grids, require_grid(grids, "target", options.input, "vam-slice writes one")));
  if (grey && in.target.front().units != "relative") {
    throw Error{Fault::data, options.input + ": is in " + in.target.front().units +
                                 ", but projections have relative doses; divide it by the dose that is to be 1"};
  }
  if (!grey) warn_of_grey(in.target.front(), options.input);
  if (io::SparseVolume* insert = find_grid(grids, "insert")) {
    insert->extend_to(in.grid(), options.input);  // other programs leave the void around it out
    in.insert.push_back(taken(grids, *insert));
  }
  const auto take = [&](const char* name, const std::string& own, std::vector<io::SparseVolume>& to) {
    if (!own.empty()) to.push_back(read_grid(own, name));
    io::SparseVolume* grid = own.empty() ? find_grid(grids, name) : &to.back();
    if (grid == nullptr) return;
    if (grid->grid() != in.grid()) throw differs_from_target(*grid, own.empty() ? options.input : own);
    if (own.empty()) to.push_back(taken(grids, *grid));
  };
  take("weight", options.weights, in.weight);
  take("tolerance", options.band_volume, in.tolerance);
  for (const std::string& path : options.delivered) in.delivered.push_back(read_dose(path));
  return in;
}

namespace {

/// Slices of the volume, `outside` in the margin around it.
optimize::VolumeSource::Read padded(const std::vector<io::SparseVolume>& volumes, const Scene& scene, float outside) {
  if (volumes.empty()) return {};
  return [&volume = volumes.front(), &scene, outside](int k, int count, float* to) {
    read_around(volume, scene.grid, outside, k, count, to);
  };
}

void add_void_rule(optimize::VolumeSource& source, std::size_t pixels, const JobOptions& options) {
  const auto weight = static_cast<float>(options.void_rule == "free" ? 0 : options.void_weight);
  if (weight != 1) {
    source.weight =
        optimize::with_void(source.target, source.weight, 1, pixels, [weight](float& value) { value *= weight; });
  }
  if (options.void_rule != "below" && !options.void_band) return;
  const double most = options.void_rule == "below" ? options.demands.window.low : *options.void_band;
  source.tolerance = optimize::with_void(source.target, source.tolerance, static_cast<float>(options.demands.band),
                                         pixels, [most](float& value) { value = static_cast<float>(most); });
}

optimize::VolumeSource::Read delivered_dose(const Scene& scene, const JobVolumes& in, const JobOptions& options) {
  if (in.delivered.empty()) return {};
  for (std::size_t i = 0; i < in.delivered.size(); ++i) {
    const model::Grid& grid = in.delivered[i].grid();
    if (model::same_voxels(grid, scene.grid)) continue;
    throw Error{Fault::data, options.delivered[i] + ": has " + model::place_text(grid) + ", but light reaches " +
                                 model::place_text(scene.grid) +
                                 "; compute it by vam-dose --like with this target and these settings"};
  }
  const double critical = scene.printer.resin.critical_dose_mj_cm3.value();
  const auto relative = static_cast<float>(options.demands.window.threshold() / critical);
  return [&doses = in.delivered, &scene, relative](int k, int count, float* to) {
    std::vector<float> dose(product(count, scene.grid.slice_size()));
    std::fill_n(to, dose.size(), 0.0F);
    for (const io::SparseVolume& one : doses) {
      one.read_slices(k, count, dose.data());
      for (std::size_t i = 0; i < dose.size(); ++i) to[i] += relative * dose[i];
    }
  };
}

}  // namespace

optimize::VolumeSource source_of(const JobVolumes& in, const Scene& scene, const JobOptions& options) {
  optimize::VolumeSource source;
  source.slices = scene.grid.nz;
  source.target = padded(in.target, scene, 0);
  source.insert = padded(in.insert, scene, 0);
  source.weight = padded(in.weight, scene, 1);
  source.tolerance = padded(in.tolerance, scene, static_cast<float>(options.demands.band));
  source.delivered = delivered_dose(scene, in, options);
  source.band_px = options.surface_margin_mm / in.grid().voxel_mm;
  add_void_rule(source, scene.grid.slice_size(), options);
  return source;
}

}  // namespace vam::session
