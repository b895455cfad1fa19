// SPDX-License-Identifier: GPL-3.0-or-later
// The verdict on a dose in one line: will it print, with what margin, how long, and from how many voxels
// these are computed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/text/json_fwd.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/light_width.hpp"
#include "verdict/print_pieces.hpp"
#include "verdict/unresolved.hpp"

namespace vam::verdict {

/// Figures are relative (DoseStatistics::metrics(true)).
struct Verdict {
  model::DoseMetrics whole;     // of the voxels wholly in part or void
  model::DoseMetrics with_cut;  // with those that the surface cuts, as part from half coverage on, else as void
  std::optional<double> seconds = std::nullopt;    // of the print; none: the resin is not known
  std::optional<double> threshold = std::nullopt;  // dose that sets the resin; none: the exposure puts it in the window
  Unresolved unresolved = {};  // walls and gaps that the voxels are too coarse for, and no figure judges
  std::optional<PrintPieces> pieces = std::nullopt;  // none: not counted
  model::LightWidth light = {};                      // that the doses are of
};

enum class Answer {
  not_judged,       // no voxel is wholly inside the part
  no,               // neither the threshold, nor any where none is given, prints all voxels wholly in part or void
  not_as_designed,  // walls will be missing, cut off or joined, or gaps shut
  unsure,           // too much is not judged, or neither voxels nor dose tell what hangs together
  yes
};
[[nodiscard]] Answer answer(const Verdict& verdict);

/// The pieces of part and print, of which the part's own surface may tell the number.
void set_pieces(Verdict& verdict, const std::optional<PrintPieces>& pieces);

/// Differences of print and part: pieces, walls, gaps and holes. Empty if none is certain or possible.
[[nodiscard]] std::string words(const PrintPieces& pieces);

/// The numbers of both.
void add_to(Json& figures, const PrintPieces& pieces);

/// E.g. "will print: process window +0.065 of the largest dose, VER 0 (412345 voxels); including the 43492 voxels cut
/// by the surface: process window -0.31, VER 0.004; duration 360 s". It begins with the answer: "not judged", "will not
/// print", "will not print as designed", "may print" or "will print"; or with what is said in its place.
[[nodiscard]] std::string words(const Verdict& verdict, const std::string& instead = "");

/// verdict, prints (0 or 1: Answer::yes), with_surface (ver, pw, iou and the number of voxels), threshold_margin where
/// the threshold is given and both have a dose (below_part and above_void, relative; negative outside the window), and
/// the pieces, where they are counted.
void add_to(Json& figures, const Verdict& verdict);

}  // namespace vam::verdict
