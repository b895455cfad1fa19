// SPDX-License-Identifier: GPL-3.0-or-later
// A dose in a file scored against the target in another.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "base/memory.hpp"
#include "base/progress.hpp"
#include "facts.hpp"
#include "io/vdb/covered.hpp"
#include "io/vdb/vdb.hpp"
#include "model/dose_metrics.hpp"
#include "model/grid_place.hpp"
#include "model/grid_size.hpp"
#include "model/printer.hpp"
#include "optics/writable_radius.hpp"
#include "own_grid.hpp"
#include "score/grey_score.hpp"
#include "score/score.hpp"
#include "unresolved.hpp"
#include "verdict/print_pieces.hpp"

namespace vam::tool {

/// The circle that is judged: void outside it is not.
inline model::Circle judged_circle(const io::SparseVolume& target, const model::Printer& printer) {
  const double farthest_mm = io::farthest_mm(target, model::coverage_rounding);
  return model::judged_circle(target.grid(), optics::judged_radius_mm(printer, farthest_mm));
}

/// The circle that is judged, the threshold that the light was made for, and for a dose in mJ/cm3 of a resin with a
/// critical dose the exposure, with that threshold where it is the dose of a whole print.
inline void settle_exposure(score::ScoreOptions& how, const io::SparseVolume& dose, const io::SparseVolume& target,
                            const model::Printer& printer) {
  how.circle = judged_circle(target, printer);
  how.voxel_mm = target.grid().voxel_mm;
  how.aimed_at = threshold_dose(dose.metadata);
  how.part = io::covered_box(target, model::coverage_rounding);
  how.own_surface = own_surface(target);
  if (dose.units != "mJ/cm3" || !printer.resin.critical_dose_mj_cm3) return;
  how.exposure = {printer, stated_number(dose.metadata, "vam:full_intensity_turns")};
  if (!how.threshold && how.exposure->full_intensity_turns) how.threshold = printer.resin.critical_dose_mj_cm3;
}

/// What is added to a score, slab by slab: both on the same grid.
template <class Score>
Score with_volumes(Score result, const io::SparseVolume& dose, const io::SparseVolume& target,
                   const char* title = "scoring") {
  constexpr int slab = 16;
  const model::Grid& grid = target.grid();
  constexpr double volumes = 4;  // both; pieces are counted in copies
  require_memory(volumes * sizeof(float) * slab * static_cast<double>(grid.slice_size()),
                 target.name() + ": " + model::size_text(grid), "use larger voxels");
  std::vector<float> doses(grid.slice_size() * slab);
  std::vector<float> wanted(grid.slice_size() * slab);
  Progress progress(title, grid.nz);
  for (int k = 0; k < grid.nz; k += slab) {
    const int count = std::min(slab, grid.nz - k);
    dose.read_slices(k, count, doses.data());
    target.read_slices(k, count, wanted.data());
    result.add(doses.data(), wanted.data(), count);
    progress.tick(count);
  }
  return result;
}

/// Against coverage.
inline score::Score score_volumes(const io::SparseVolume& dose, const io::SparseVolume& target,
                                  const score::ScoreOptions& how) {
  return with_volumes(score::Score(how, target.grid().nx, target.grid().ny), dose, target);
}

/// Against coverage, and by the pieces of the print.
inline score::Score score_print(const io::SparseVolume& dose, const io::SparseVolume& target,
                                const score::ScoreOptions& how) {
  score::Score result = score_volumes(dose, target, how);
  const model::Grid& grid = target.grid();
  const double threshold = result.print_threshold();
  if (!(threshold > 0)) return result;  // the part stays dark
  verdict::PrintPieceCounter counter(grid.nx, grid.ny, threshold, how.circle);
  verdict::PrintPieces pieces = with_volumes(std::move(counter), dose, target, "counting pieces").found();
  pieces.set_places(grid, stretch_z(target.metadata));
  result.set_pieces(pieces);
  return result;
}

/// A grey score that takes the band of each voxel beside its dose and target.
class BandedScore {
 public:
  /// band: of a part of the grid, around which it is `around`; nullptr: it is the same for all.
  BandedScore(const score::GreyScore& start, const model::Grid& grid, const io::SparseVolume* band, double around)
      : score_(start), grid_(grid), band_(band), around_(static_cast<float>(around)) {
    if (band == nullptr) return;
    const auto place = model::place_in(grid, band->grid());
    if (!place) throw differs_from_target(*band, "target");
    place_ = *place;
  }
  void add(const float* dose, const float* target, int count) {
    const std::vector<float> band = next_bands(count);
    score_.add(dose, target, count, band.empty() ? nullptr : band.data());
    slices_ += count;
  }
  [[nodiscard]] const score::GreyScore& score() const { return score_; }

 private:
  [[nodiscard]] std::vector<float> next_bands(int count) const {
    if (band_ == nullptr) return {};
    std::vector<float> bands(grid_.slice_size() * static_cast<std::size_t>(count), around_);
    const model::Grid& own = band_->grid();
    std::vector<float> slice(own.slice_size());
    for (int n = 0; n < count; ++n) {
      const int k = slices_ + n - place_[2];
      if (k < 0 || k >= own.nz) continue;
      band_->read_slices(k, 1, slice.data());
      float* to = bands.data() + grid_.slice_size() * static_cast<std::size_t>(n) + place_[0];
      for (int y = 0; y < own.ny; ++y)
        std::copy_n(slice.data() + product(y, own.nx), own.nx, to + product(place_[1] + y, grid_.nx));
    }
    return bands;
  }

  score::GreyScore score_;
  model::Grid grid_;
  const io::SparseVolume* band_;
  float around_;
  std::array<int, 3> place_{};
  int slices_ = 0;
};

/// Against a grey target. band: of each voxel; nullptr: it is the same for all.
inline score::GreyScore score_grey_volumes(const io::SparseVolume& dose, const io::SparseVolume& target,
                                           const score::GreyOptions& how, const io::SparseVolume* band) {
  const model::Grid& grid = target.grid();
  const BandedScore start(score::GreyScore(how, grid.nx, grid.ny), grid, band, how.band);
  return with_volumes(start, dose, target).score();
}

}  // namespace vam::tool
