// SPDX-License-Identifier: GPL-3.0-or-later
// Is a dose printable? The field's figures of merit of a dose against its target, as table and JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "model/circle.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/dose/stray_cure.hpp"
#include "model/grid.hpp"
#include "model/light_width.hpp"
#include "model/printer.hpp"
#include "score/exposure.hpp"
#include "verdict/verdict.hpp"

namespace vam::score {

/// What the dose was given with.
struct Exposure {
  model::Printer printer;                      // with a critical dose
  std::optional<double> full_intensity_turns;  // that gave the dose of a print; none: the dose is that of one turn
  std::optional<double> seconds = {};          // of that print
};

struct ScoreOptions {
  std::string target = "target";         // begins the messages on it
  model::Circle circle;                  // void outside it is not judged: the writable one,
  double writable_mm = 0;                // of this radius, or what the light was made for
  model::Grid grid;                      // of dose and target; voxel_mm 0: not known
  double stretch_z = 1;                  // of that grid
  bool surface = false;                  // surface voxels count too: part when at least half covered, else void
  bool absolute = false;                 // PW and IPDR in the dose's unit instead of fractions of the largest dose
  double trim = 0.02;                    // alpha: extremes are also given at the alpha/2 percentiles
  std::optional<double> threshold;       // the critical dose, in the dose's unit; none: that of the planned exposure
  std::optional<double> stated;          // what the dose states in its place, where it is given
  std::optional<double> aimed_at;        // the threshold that its light was made for, in the dose's unit
  model::LightWidth light;               // of the dose, as it states it
  std::optional<Exposure> exposure;      // known when the dose is in mJ/cm3
  std::optional<model::VoxelBox> part;   // its box; none: what lies outside it is not told
  verdict::SubVoxelFeatures unresolved;  // of the target
};

/// Of the figures by name those that only an exposure has.
[[nodiscard]] bool is_of_exposure(const std::string& figure);

/// Gathers slices in ascending order; each is judged on a thread of its own.
class Score {
 public:
  Score(const ScoreOptions& options, int width, int height);

  /// `count` row-major slices of dose and of target coverage. Throws Fault::data for a dose that is not finite.
  void add(const float* dose, const float* target, int count);
  /// Counted by the caller, as the print is known once all slices have been added.
  void attach_topology(const verdict::PrintPieces& pieces) { pieces_ = pieces; }
  /// The projections that gave the dose, for the efficiency of light.
  void add_projection(std::span<const float> values) { light_.add(values); }

  /// Throws Fault::data when the target has no part voxel or no void voxel was judged.
  [[nodiscard]] Json figures() const;

  /// The figures by name (for --require), in the order of the table.
  [[nodiscard]] static const std::vector<std::string>& names();
  [[nodiscard]] double figure(const std::string& name) const;
  /// The dose whose isosurface the print is (verdict::print_threshold), for the dose of a turn by the planned exposure.
  [[nodiscard]] double print_threshold() const { return sets_at().dose; }
  /// None where the exposure is not known, or nothing is lit.
  [[nodiscard]] std::optional<ExposurePlan> plan() const;
  /// Of the relative figures, whatever the options say.
  [[nodiscard]] verdict::Verdict verdict() const;
  /// Aligned lines "figure value meaning", and the verdict in words.
  /// `ending`: behind the verdict.
  [[nodiscard]] std::string table(const std::string& ending = "") const;

 private:
  struct Figure;
  [[nodiscard]] static const std::vector<Figure>& figure_list();

  [[nodiscard]] verdict::PrintThreshold sets_at() const;
  [[nodiscard]] const model::DoseStatistics& judged() const { return options_.surface ? with_cut_ : whole_; }
  [[nodiscard]] model::DoseMetrics metrics() const { return judged().metrics(!options_.absolute); }
  [[nodiscard]] model::DoseMetrics trimmed() const { return judged().trimmed(options_.trim, !options_.absolute); }
  /// At the critical dose, or at the threshold of the planned exposure; none where there is neither.
  [[nodiscard]] std::optional<model::ThresholdMetrics> at_critical() const;

  [[nodiscard]] bool in_box(std::size_t pixel, int slice) const {
    const auto width = static_cast<std::size_t>(width_);
    return options_.part->contains(static_cast<int>(pixel % width), static_cast<int>(pixel / width), slice);
  }
  [[nodiscard]] std::optional<model::StrayCure> outside() const;
  /// That of the circle in which all void was judged, where the volume ends within the writable one.
  [[nodiscard]] std::optional<double> judged_radius_mm() const;

  ScoreOptions options_;
  int width_;
  double rim_px_ = 0;  // of the largest circle in a slice
  verdict::JudgedRegion region_;
  model::DoseStatistics whole_, with_cut_;  // without and with the voxels that the surface cuts
  model::LightEfficiency light_;
  std::optional<verdict::PrintPieces> pieces_;
  std::int64_t surface_ = 0;
  int slices_ = 0;             // seen
  model::StrayDoses outside_;  // void outside the part's box
};

}  // namespace vam::score
