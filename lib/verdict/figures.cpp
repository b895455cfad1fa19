// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of a verdict: each stands once, for tables, conditions and reports.
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "verdict/verdict.hpp"

namespace vam::verdict {

namespace {

template <auto Value>
Json of_pieces(const Verdict& verdict) {
  const auto& pieces = verdict.print.pieces;
  return pieces ? Json(std::invoke(Value, *pieces)) : Json(nullptr);
}

}  // namespace

double window_middle(const model::DoseMetrics& doses) {
  return doses.min_part > doses.max_void ? 0.5 * (doses.min_part + doses.max_void) : doses.iou_threshold;
}

double aimed_dose(const model::DoseMetrics& doses, std::optional<double> threshold) {
  const double quarter = 0.25 * (doses.min_part - doses.max_void);
  const double middle = window_middle(doses);
  return threshold && std::abs(*threshold - middle) <= quarter ? *threshold : middle;
}

PrintThreshold print_threshold(const model::DoseMetrics& doses, std::optional<double> of_exposure,
                               std::optional<double> of_light) {
  if (of_exposure) return {*of_exposure, false};
  const double aimed = aimed_dose(doses, of_light);
  return {aimed, aimed != of_light};
}

std::optional<ThresholdMargin> threshold_margin(const GivenPrint& print) {
  const model::DoseMetrics& doses = print.whole;
  if (!print.threshold || doses.part == 0 || !(doses.max_void > 0) || !(doses.min_part > 0)) return std::nullopt;
  return ThresholdMargin{1 - *print.threshold / doses.min_part, *print.threshold / doses.max_void - 1};
}

const std::vector<Figure>& figures() {
  static const std::string margin = format_number(100 * dose_margin) + " %";
  static const std::vector<Figure> all{
      {"unresolved_part", "fraction of the part in walls of which no voxel is wholly inside; they are not judged",
       [](const Verdict& verdict) { return Json(verdict.unresolved.part_share()); }},
      {"unresolved_gaps", "gaps of which no voxel is wholly outside, relative to the part; they are not judged",
       [](const Verdict& verdict) { return Json(verdict.unresolved.gap_share()); }},
      {"part_pieces", "separate pieces of the part, thin rods included", of_pieces<&PrintPieces::part>},
      {"part_pieces_at_half", "separate pieces of the part where it is half covered; narrow gaps part them",
       of_pieces<&PrintPieces::part_at_half>},
      {"print_pieces", "separate pieces of the print; pieces below 8 voxels are not counted",
       of_pieces<&PrintPieces::print>},
      {"print_pieces_least", "the fewest with up to " + margin + " less or more dose",
       of_pieces<&PrintPieces::print_least>},
      {"print_pieces_most", "the most with up to " + margin + " less or more dose",
       of_pieces<&PrintPieces::print_most>},
      {"broken_voxels", "voxels at least half part that do not cure and where walls are cut or missing",
       of_pieces<[](const PrintPieces& pieces) { return pieces.broken.voxels; }>},
      {"shut_voxels", "voxels less than a quarter part that cure and where gaps are shut",
       of_pieces<[](const PrintPieces& pieces) { return pieces.shut.voxels; }>},
      {"holes", "holes of the print, through walls or between bridges over gaps, beyond those of the part",
       of_pieces<&PrintPieces::holes>},
      {"firm_holes", "of these, those on which " + margin + " of the dose do not decide",
       of_pieces<&PrintPieces::firm_holes>},
      {"prints", "1 if the part will print as designed, 0 if it will not or may not", [](const Verdict& verdict) {
         return verdict.answer == Answer::left_open ? Json(nullptr) : Json(verdict.answer == Answer::yes ? 1 : 0);
       }}};
  return all;
}

void add_findings(Json& report, const Verdict& verdict) {
  const GivenPrint& print = verdict.print;
  report["verdict"] = verdict.words;
  if (const std::int64_t voxels = print.with_cut.part + print.with_cut.void_; voxels > 0) {
    report["with_surface"] = {
        {"voxels", voxels}, {"ver", print.with_cut.ver}, {"pw", print.with_cut.pw}, {"iou", print.with_cut.iou}};
  }
  if (const auto by = threshold_margin(print))
    report["threshold_margin"] = {{"below_part", by->below_part}, {"above_void", by->above_void}};
  if (!print.pieces) return;
  if (print.pieces->solids > 0) report["solids"] = print.pieces->solids;
  if (const auto at = print.place_mm(print.pieces->broken)) report["broken_at_mm"] = *at;
  if (const auto at = print.place_mm(print.pieces->shut)) report["shut_at_mm"] = *at;
}

void append_json(Json& report, const Verdict& verdict) {
  for (const Figure& figure : figures()) {
    Json value = figure.value(verdict);
    if (!value.is_null() || figure.name == "prints") report[figure.name] = std::move(value);
  }
  add_findings(report, verdict);
}

}  // namespace vam::verdict
