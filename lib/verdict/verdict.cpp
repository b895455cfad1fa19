// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/verdict.hpp"

#include <array>
#include <string>
#include <vector>

#include "base/text/json.hpp"
#include "base/text/text.hpp"

namespace vam::verdict {

namespace {

std::int64_t voxels(const model::DoseMetrics& m) { return m.part + m.void_; }

std::string margin(const model::DoseMetrics& m) { return (m.pw > 0 ? "+" : "") + format_number(m.pw, 3); }

bool holds_threshold(const Verdict& verdict) {
  const auto& t = verdict.threshold;
  return !t || (verdict.whole.max_void < *t && *t <= verdict.whole.min_part);
}

/// Position of a given threshold in the process window.
struct ThresholdMargin {
  double below_part = 0, above_void = 0;  // relative to the part's least dose and to the void's largest
};

std::optional<ThresholdMargin> threshold_margin(const Verdict& verdict) {
  const model::DoseMetrics& doses = verdict.whole;
  if (!verdict.threshold || doses.part == 0 || !(doses.max_void > 0) || !(doses.min_part > 0)) return std::nullopt;
  return ThresholdMargin{1 - *verdict.threshold / verdict.whole.min_part,
                         *verdict.threshold / verdict.whole.max_void - 1};
}

std::string margin_text(const ThresholdMargin& margin) {
  return "; the threshold is " + format_number(100 * margin.below_part, 2) +
         " % below its least dose in the part and " + format_number(100 * margin.above_void, 2) +
         " % above its largest in the void";
}

std::string in_pieces(int count) { return std::to_string(count) + (count == 1 ? " piece" : " pieces"); }

std::string place(const std::optional<std::array<double, 3>>& at_mm) {
  if (!at_mm) return "";
  const auto& [x, y, z] = *at_mm;
  return ", most at x, y, z = " + format_number(x, 3) + ", " + format_number(y, 3) + ", " + format_number(z, 3) + " mm";
}

std::vector<std::string> of_pieces(const PrintPieces& pieces) {
  const std::string pieces_found = "the print is in " + in_pieces(pieces.print);
  if (pieces.is_in_other_pieces())
    return {pieces_found + ", the part in " + std::to_string(pieces.solids > 0 ? pieces.solids : pieces.part)};
  if (!pieces.knows_pieces()) {
    return {pieces_found + ", and the voxels are too coarse to tell whether the part is in " +
            std::to_string(pieces.part) + " or " + std::to_string(pieces.part_at_half)};
  }
  if (!pieces.may_be_in_other_pieces()) return {};
  return {pieces_found + ", but with up to 2 % less or more dose in " + std::to_string(pieces.print_least()) + " to " +
          std::to_string(pieces.print_most())};
}

const char* beginning(Answer answer) {
  switch (answer) {
    case Answer::not_judged:
      return "not judged, as no voxel is wholly inside the part";
    case Answer::no:
      return "will not print";
    case Answer::not_as_designed:
      return "will not print as designed";
    case Answer::unsure:
      return "may print";
    case Answer::yes:
      break;
  }
  return "will print";
}

std::string unjudged(const Unresolved& un) {
  const auto percent = [](double share) { return format_number(100 * share, 3) + " % of the part"; };
  std::string text;
  if (un.loses_walls() && un.loses_much()) {
    text += "; " + percent(un.lost_share()) + " is in walls too thin for the voxels and will be missing";
  } else if (un.loses_walls()) {
    text += "; walls or rods too thin for the voxels will be missing";
  }
  if (un.shuts_gaps()) text += "; gaps too narrow for the voxels will be shut";
  const std::string thin = un.thin_places();
  if (!thin.empty()) text += "; " + thin + " are not judged; smaller voxels resolve them";
  if (un.is_most() || (!un.surface && un.is_much()))
    text += "; walls and gaps too thin for the voxels are not judged: " + percent(un.share()) +
            "; smaller voxels resolve them";
  return text;
}

}  // namespace

Answer answer(const Verdict& verdict) {
  const Unresolved& un = verdict.unresolved;
  const auto& pieces = verdict.pieces;
  if (verdict.whole.part == 0) return Answer::not_judged;
  if (!(verdict.whole.pw > 0) || !holds_threshold(verdict)) return Answer::no;
  if (un.loses_walls() || un.shuts_gaps() || (pieces && !pieces->is_as_part())) return Answer::not_as_designed;
  return un.leaves_doubt() || (pieces && !pieces->is_certain()) ? Answer::unsure : Answer::yes;
}

void set_pieces(Verdict& verdict, const std::optional<PrintPieces>& pieces) {
  verdict.pieces = pieces;
  const auto& surface = verdict.unresolved.surface;
  if (verdict.pieces && surface) verdict.pieces->set_solids(surface->places);
}

std::string words(const PrintPieces& pieces) {
  std::vector<std::string> all = of_pieces(pieces);
  if (pieces.loses_walls()) {
    all.push_back("walls are cut or missing: " + std::to_string(pieces.broken.voxels) +
                  " voxels that the part fills by half or more do not cure" + place(pieces.broken_at_mm));
  }
  if (pieces.shuts_gaps()) {
    all.push_back("gaps are shut: " + std::to_string(pieces.shut.voxels) +
                  " voxels that the part fills by less than a quarter cure" + place(pieces.shut_at_mm));
  }
  if (pieces.may_have_holes()) {
    all.push_back(std::string("walls ") + (pieces.has_holes() ? "are" : "may be") +
                  " pierced or gaps bridged: the print has " + std::to_string(pieces.holes) +
                  (pieces.holes == 1 ? " hole" : " holes") + " that the part has not" +
                  (pieces.has_holes() ? "" : ", which 2 % less or more dose would close or open"));
  }
  return join(all, "; ");
}

void add_to(Json& figures, const PrintPieces& pieces) {
  figures["part_pieces"] = pieces.part;
  if (pieces.solids > 0) figures["solids"] = pieces.solids;
  figures["part_pieces_at_half"] = pieces.part_at_half;
  figures["print_pieces"] = pieces.print;
  figures["print_pieces_least"] = pieces.print_least();
  figures["print_pieces_most"] = pieces.print_most();
  figures["broken_voxels"] = pieces.broken.voxels;
  if (pieces.broken_at_mm) figures["broken_at_mm"] = *pieces.broken_at_mm;
  figures["shut_voxels"] = pieces.shut.voxels;
  if (pieces.shut_at_mm) figures["shut_at_mm"] = *pieces.shut_at_mm;
  figures["holes"] = pieces.holes;
  figures["firm_holes"] = pieces.firm_holes;
}

std::string words(const Verdict& verdict, const std::string& instead) {
  const std::int64_t cut = voxels(verdict.with_cut) - voxels(verdict.whole);
  const Answer judged = answer(verdict);
  std::string line = instead.empty() ? beginning(judged) : instead;
  if (!holds_threshold(verdict)) {
    line += " at the threshold of " + format_number(*verdict.threshold, 3) + " (void up to " +
            format_number(verdict.whole.max_void, 3) + ", part at least " + format_number(verdict.whole.min_part, 3) +
            ")";
  }
  line += ": process window " + margin(verdict.whole) + " of the largest dose, VER " +
          format_number(verdict.whole.ver, 3) + " (" + std::to_string(voxels(verdict.whole)) + " voxels)";
  if (const auto by = threshold_margin(verdict); by && judged > Answer::no) line += margin_text(*by);
  if (cut > 0) {
    line += "; including the " + std::to_string(cut) + " voxels cut by the surface: process window " +
            margin(verdict.with_cut) + ", VER " + format_number(verdict.with_cut.ver, 3);
  }
  if (judged > Answer::no && verdict.pieces && !words(*verdict.pieces).empty()) line += "; " + words(*verdict.pieces);
  line += unjudged(verdict.unresolved);
  if (verdict.light != model::LightWidth{}) line += "; by " + model::words(verdict.light);
  if (verdict.seconds) line += "; duration " + format_number(*verdict.seconds, 4) + " s";
  return line;
}

void add_to(Json& figures, const Verdict& verdict) {
  figures["verdict"] = words(verdict);
  figures["prints"] = answer(verdict) == Answer::yes ? 1 : 0;
  figures["with_surface"] = {{"voxels", voxels(verdict.with_cut)},
                             {"ver", verdict.with_cut.ver},
                             {"pw", verdict.with_cut.pw},
                             {"iou", verdict.with_cut.iou}};
  if (const auto by = threshold_margin(verdict))
    figures["threshold_margin"] = {{"below_part", by->below_part}, {"above_void", by->above_void}};
  if (verdict.pieces) add_to(figures, *verdict.pieces);
}

}  // namespace vam::verdict
