// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/dose_score.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/compute/memory.hpp"
#include "base/index.hpp"
#include "base/log/progress.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/grid_size.hpp"
#include "model/light_width.hpp"
#include "optics/writable_radius.hpp"
#include "session/volumes.hpp"
#include "verdict/print_pieces.hpp"

namespace vam::session {

namespace {

constexpr int slab = 16;

void require_slabs(const io::SparseVolume& target) {
  constexpr double copies = 4;  // of both; pieces are counted in copies
  require_memory(copies * sizeof(float) * slab * static_cast<double>(target.grid().slice_size()),
                 target.name() + ": " + model::size_text(target.grid()), "use larger voxels");
}

/// add(first slice, count, dose, coverage) for all, a slab at a time.
template <class Add>
void for_each_slab(const io::SparseVolume& dose, const io::SparseVolume& target, const char* title, const Add& add) {
  require_slabs(target);
  const model::Grid& grid = dose.grid();
  std::vector<float> doses(grid.slice_size() * slab), coverage(doses.size());
  Progress progress(title, grid.nz);
  for (int k = 0; k < grid.nz; k += slab) {
    const int count = std::min(slab, grid.nz - k);
    dose.read_slices(k, count, doses.data());
    target.read_slices(k, count, coverage.data());
    add(k, count, doses.data(), coverage.data());
    progress.tick(count);
  }
}

}  // namespace

double judged_radius_mm(const io::SparseVolume& target, const model::Printer& printer, const model::Metadata& light) {
  const double most = optics::judged_radius_mm(printer, io::farthest_mm(target, model::coverage_rounding));
  return std::min(most, model::stated_number(light, "vam:judged_radius_mm").value_or(most));
}

verdict::SubVoxelFeatures unresolved(const io::SparseVolume& target) {
  constexpr std::size_t million = 1'000'000;  // voxels at a time
  const model::Grid& grid = target.grid();
  const int most = static_cast<int>(std::clamp<std::size_t>(million / grid.slice_size(), 1, slab));
  verdict::SubVoxelFinder finder(grid);
  std::vector<float> slices(product(most, grid.slice_size()));
  for (int k = 0; k < grid.nz; k += most) {
    const int count = std::min(most, grid.nz - k);
    target.read_slices(k, count, slices.data());
    finder.add(count, slices.data());
  }
  verdict::SubVoxelFeatures found = finder.found();
  if (const auto places = model::stated_surface(target.metadata)) found.surface = {*places, grid.voxel_mm};
  return found;
}

void resolve_exposure(score::ScoreOptions& how, const io::SparseVolume& dose, const io::SparseVolume& target,
                      const model::Printer& printer) {
  how.grid = target.grid();
  how.circle = model::judged_circle(how.grid, judged_radius_mm(target, printer, dose.metadata));
  how.writable_mm = judged_radius_mm(target, printer, {});
  how.stretch_z = model::stretch_z(target.metadata);
  how.light = model::stated_width(dose.metadata);
  how.aimed_at = model::threshold_dose(dose.metadata);
  how.part = io::covered_box(target, model::coverage_rounding);
  std::optional<double> stated = how.aimed_at;
  if (dose.units == "mJ/cm3" && printer.resin.critical_dose_mj_cm3) {
    how.exposure = {printer, model::stated_number(dose.metadata, "vam:full_intensity_turns"),
                    model::stated_number(dose.metadata, "vam:print_s")};
    if (how.exposure->full_intensity_turns) stated = printer.resin.critical_dose_mj_cm3;
  }
  if (how.threshold && stated != how.threshold) how.stated = stated;
  if (!how.threshold && how.exposure && how.exposure->full_intensity_turns) how.threshold = stated;
}

score::Score score_volumes(const io::SparseVolume& dose, const io::SparseVolume& target,
                           const score::ScoreOptions& how) {
  score::Score result(how, target.grid().nx, target.grid().ny);
  for_each_slab(dose, target, "scoring",
                [&](int, int count, const float* x, const float* f) { result.add(x, f, count); });
  return result;
}

score::Score score_print(const io::SparseVolume& dose, const io::SparseVolume& target, score::ScoreOptions how) {
  require_slabs(target);
  how.unresolved = unresolved(target);
  score::Score result = score_volumes(dose, target, how);
  const double threshold = result.print_threshold();
  if (!(threshold > 0)) return result;  // the part stays dark
  verdict::PrintPieceCounter counter(how.grid.nx, how.grid.ny, threshold, how.circle);
  for_each_slab(dose, target, "counting pieces",
                [&](int, int count, const float* x, const float* f) { counter.add(x, f, count); });
  result.attach_topology(counter.found());
  return result;
}

score::GreyScore score_grey(const io::SparseVolume& dose, const io::SparseVolume& target, const GreyChoice& grey,
                            const io::SparseVolume* band, const model::Printer& printer, const std::string& file) {
  const model::Grid& grid = target.grid();
  score::GreyOptions how = grey.options();
  how.circle = model::judged_circle(grid, judged_radius_mm(target, printer, dose.metadata));
  how.unit = grey_unit(target, dose, file);
  require_linear(dose, file);
  score::GreyScore result(how, grid.nx, grid.ny);
  std::optional<io::SparseVolume> named;
  if (!grey.band_volume.empty()) band = &named.emplace(read_grid(grey.band_volume, "tolerance"));
  std::vector<float> bands;
  for_each_slab(dose, target, "scoring", [&](int k, int count, const float* x, const float* f) {
    if (band == nullptr) return result.add(x, f, count);
    bands.resize(product(count, grid.slice_size()));
    read_around(*band, grid, static_cast<float>(how.band), k, count, bands.data());
    result.add(x, f, count, bands.data());
  });
  return result;
}

}  // namespace vam::session
