// SPDX-License-Identifier: GPL-3.0-or-later
// The judge: will a dose print a part? Every program asks it, of a dose on the print's own voxels or on coarser ones.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/grid.hpp"
#include "model/light_width.hpp"
#include "verdict/print_pieces.hpp"
#include "verdict/sub_voxel_features.hpp"

namespace vam::verdict {

/// The dose half way between the void's largest and the part's least; where void takes more than part, the middle of
/// the thresholds that print best. `doses` are absolute (DoseStatistics::metrics(false)), in any unit.
[[nodiscard]] double window_middle(const model::DoseMetrics& doses);

/// The dose that a print brings to the critical one: the threshold that its light was made for, while that is in the
/// middle half of the window, as the dose at the part's surface is that; else the window's middle.
[[nodiscard]] double aimed_dose(const model::DoseMetrics& doses, std::optional<double> threshold);

/// The dose at which a print sets, to every tool: what its exposure brings to the critical dose, as stated, planned or
/// given, else what one would be aimed at. best: neither exposure nor light state it.
struct PrintThreshold {
  double dose = 0;
  bool best = false;
};
[[nodiscard]] PrintThreshold print_threshold(const model::DoseMetrics& doses, std::optional<double> of_exposure,
                                             std::optional<double> of_light);

/// A dose on the voxels of a part. Figures are relative (DoseStatistics::metrics(true)).
struct GivenPrint {
  model::DoseMetrics whole = {};     // of the voxels wholly in part or void
  model::DoseMetrics with_cut = {};  // with those that the surface cuts, as part from half coverage on, else as void
  std::optional<PrintPieces> pieces = std::nullopt;  // none: not counted
  model::Grid grid = {};                             // on which they were; voxel_mm 0: not known
  double stretch_z = 1;                              // of that grid
  model::LightWidth light = {};                      // that the dose is of
  std::optional<double> seconds = std::nullopt;      // that it takes; none: the resin is not known
  std::optional<double> threshold = std::nullopt;  // dose that sets the resin; none: the exposure puts it in the window
  std::optional<double> best = std::nullopt;       // at which the pieces are counted where nothing states it

  /// A voxel of the largest of these defects, in mm of the print.
  [[nodiscard]] std::optional<std::array<double, 3>> place_mm(const Defects& found) const {
    if (found.voxels == 0 || !(grid.voxel_mm > 0)) return std::nullopt;
    return std::array{grid.x_mm(found.at.column), grid.y_mm(found.at.row), grid.z_mm(found.at.slice) / stretch_z};
  }
};

/// Position of a given threshold in the process window, relative to the part's least dose and to the void's largest;
/// negative outside. None where there is none, or one of these has no dose.
struct ThresholdMargin {
  double below_part = 0, above_void = 0;
};
[[nodiscard]] std::optional<ThresholdMargin> threshold_margin(const GivenPrint& print);

enum class Answer {
  not_judged,       // no voxel is wholly inside the part
  no,               // neither the threshold, nor any where none is given, prints all voxels wholly in part or void
  not_as_designed,  // walls will be missing, cut off or joined, or gaps shut
  unsure,           // too much is not judged, or neither voxels nor dose tell what hangs together
  yes,
  left_open,  // of an estimate that cannot tell of the print
};

struct Verdict {
  Answer answer = Answer::not_judged;
  SubVoxelFeatures unresolved = {};  // walls and gaps that the voxels are too coarse for, and no figure judges
  GivenPrint print = {};
  /// E.g. "will print: forgives +-4.4 % of dose, process window +0.065 of the largest dose, VER 0 (412345 voxels);
  /// including the 43492 voxels cut by the surface: process window -0.31, VER 0.004; duration 360 s". It begins with
  /// the answer: "not judged", "will not print", "will not print as designed", "may print" or "will print"; or with why
  /// it is left open.
  std::string words = {};

  [[nodiscard]] bool fails() const { return answer == Answer::no || answer == Answer::not_as_designed; }
};

/// of_part: what its voxels do not resolve. It must hang together at the threshold and within dose_margin of it; where
/// the part's own surface is known, that tells the number of pieces.
[[nodiscard]] Verdict judge(const SubVoxelFeatures& of_part, const GivenPrint& print);
/// why: "unknown at 0.26 mm; --voxel 0.1 tells".
[[nodiscard]] Verdict leave_open(Verdict verdict, const std::string& why);

/// Of a grey target, which prescribes a dose for every voxel: "not met: 99 % of 1000 voxels are within 0.1 of the
/// target, the farthest is 0.2 away"; "within their bands around the target" where these are not all the same. ver:
/// outside of them; ipdr: the largest error.
[[nodiscard]] std::string grey_words(const model::DoseMetrics& figures, std::optional<double> band = std::nullopt);

/// One of a table: its name in reports and conditions, and what it is.
struct Figure {
  std::string name, meaning;
  Json (*value)(const Verdict& verdict);  // null: not known
};
/// unresolved_part, unresolved_gaps, those of the pieces, and prints: 1 for Answer::yes.
[[nodiscard]] const std::vector<Figure>& figures();
/// Beside these: verdict; with_surface (ver, pw, iou and the number of voxels); threshold_margin (below_part and
/// above_void); of the pieces solids, broken_at_mm and shut_at_mm.
void add_findings(Json& report, const Verdict& verdict);
/// All. What is not known is left out, but for prints, which is null.
void append_json(Json& report, const Verdict& verdict);

}  // namespace vam::verdict
