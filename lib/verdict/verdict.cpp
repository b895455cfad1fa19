// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/verdict.hpp"

#include <cstdint>

#include "base/text/text.hpp"

namespace vam::verdict {

namespace {

std::int64_t voxels(const model::DoseMetrics& m) { return m.part + m.void_; }

std::string margin(const model::DoseMetrics& m) { return (m.pw > 0 ? "+" : "") + format_number(m.pw, 3); }

std::string percent(double share, int digits = 3) { return format_number(100 * share, digits) + " %"; }

std::string latitude(const model::DoseMetrics& m) {
  if (m.latitude > 0) return "forgives +-" + percent(m.latitude / 2, m.latitude < 0.2 ? 2 : 3) + " of dose";
  return "latitude " + format_number(m.latitude, 2);
}

bool holds_threshold(const GivenPrint& print) {
  const auto& t = print.threshold;
  return !t || (print.whole.max_void < *t && *t <= print.whole.min_part);
}

std::string margin_text(const ThresholdMargin& margin) {
  return "; the threshold is " + percent(margin.below_part, 2) + " below its least dose in the part and " +
         percent(margin.above_void, 2) + " above its largest in the void";
}

std::string in_pieces(int count) { return std::to_string(count) + (count == 1 ? " piece" : " pieces"); }

std::string of_defects(const std::string& what, const std::string& which, const Defects& found,
                       const GivenPrint& print) {
  const std::string text =
      "; " + what + ": " + std::to_string(found.voxels) + " voxels that the part fills by " + which;
  const auto at_mm = print.place_mm(found);
  if (!at_mm) return text;
  const auto& [x, y, z] = *at_mm;
  return text + ", most at x, y, z = " + format_number(x, 3) + ", " + format_number(y, 3) + ", " + format_number(z, 3) +
         " mm";
}

std::string number_of_pieces(const PrintPieces& pieces) {
  const std::string found = "; the print is in " + in_pieces(pieces.print);
  if (pieces.is_in_other_pieces())
    return found + ", the part in " + std::to_string(pieces.solids > 0 ? pieces.solids : pieces.part);
  if (!pieces.knows_pieces()) {
    return found + ", and the voxels are too coarse to tell whether the part is in " + std::to_string(pieces.part) +
           " or " + std::to_string(pieces.part_at_half);
  }
  if (!pieces.may_be_in_other_pieces()) return "";
  return found + ", but with up to " + percent(dose_margin) + " less or more dose in " +
         std::to_string(pieces.print_least()) + " to " + std::to_string(pieces.print_most());
}

/// Differences of print and part: pieces, walls, gaps and holes.
std::string of_pieces(const PrintPieces& pieces, const GivenPrint& print) {
  std::string text = number_of_pieces(pieces);
  if (pieces.loses_walls())
    text += of_defects("walls are cut or missing", "half or more do not cure", pieces.broken, print);
  if (pieces.bridges_gaps()) text += of_defects("gaps are shut", "less than a quarter cure", pieces.shut, print);
  if (!pieces.may_have_holes()) return text;
  return text + "; walls " + (pieces.has_holes() ? "are" : "may be") + " pierced or gaps bridged: the print has " +
         std::to_string(pieces.holes) + (pieces.holes == 1 ? " hole" : " holes") + " that the part has not" +
         (pieces.has_holes() ? "" : ", which " + percent(dose_margin) + " less or more dose would close or open");
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
    case Answer::left_open:
      break;
  }
  return "will print";
}

std::string unjudged(const SubVoxelFeatures& un) {
  std::string text;
  if (un.loses_walls() && un.loses_much()) {
    text += "; " + percent(un.lost_share()) + " of the part is in walls too thin for the voxels and will be missing";
  } else if (un.loses_walls()) {
    text += "; walls or rods too thin for the voxels will be missing";
  }
  if (un.bridges_gaps()) text += "; gaps too narrow for the voxels will be shut";
  const std::string thin = un.thin_places();
  if (!thin.empty()) text += "; " + thin + " are not judged; smaller voxels resolve them";
  if (un.is_most() || (!un.surface && un.is_much()))
    text += "; walls and gaps too thin for the voxels are not judged: " + percent(un.share()) +
            " of the part; smaller voxels resolve them";
  return text;
}

Answer answer_of(const SubVoxelFeatures& un, const GivenPrint& print) {
  const auto& pieces = print.pieces;
  if (print.whole.part == 0) return Answer::not_judged;
  if (!(print.whole.pw > 0) || !holds_threshold(print)) return Answer::no;
  if (un.loses_walls() || un.bridges_gaps() || (pieces && !pieces->is_as_part())) return Answer::not_as_designed;
  return un.leaves_doubt() || (pieces && !pieces->is_certain()) ? Answer::unsure : Answer::yes;
}

/// All but what it begins with.
std::string reasons(const Verdict& verdict) {
  const GivenPrint& print = verdict.print;
  const bool may_print = verdict.answer > Answer::no;
  const std::int64_t cut = voxels(print.with_cut) - voxels(print.whole);
  std::string line;
  if (!holds_threshold(print)) {
    line += " at the threshold of " + format_number(*print.threshold, 3) + " (void up to " +
            format_number(print.whole.max_void, 3) + ", part at least " + format_number(print.whole.min_part, 3) + ")";
  }
  line += ": " + latitude(print.whole) + ", process window " + margin(print.whole) + " of the largest dose, VER " +
          format_number(print.whole.ver, 3) + " (" + std::to_string(voxels(print.whole)) + " voxels)";
  if (const auto by = threshold_margin(print); by && may_print) line += margin_text(*by);
  if (cut > 0) {
    line += "; including the " + std::to_string(cut) + " voxels cut by the surface: process window " +
            margin(print.with_cut) + ", VER " + format_number(print.with_cut.ver, 3);
  }
  if (may_print && print.pieces) {
    const std::string differences = of_pieces(*print.pieces, print);
    line += differences.empty() ? "; its pieces are those of the part within +-" + percent(dose_margin) + " of dose"
                                : differences;
  }
  if (print.best) line += "; judged at the best threshold, " + format_number(*print.best, 3);
  line += unjudged(verdict.unresolved);
  if (print.light != model::LightWidth{}) line += "; by " + model::words(print.light);
  if (print.seconds) line += "; duration " + format_number(*print.seconds, 4) + " s";
  return line;
}

}  // namespace

Verdict judge(const SubVoxelFeatures& of_part, const GivenPrint& print) {
  Verdict verdict{.unresolved = of_part, .print = print};
  if (auto& pieces = verdict.print.pieces; pieces && of_part.surface) {
    pieces->solids = of_part.surface->places.solids;
    pieces->specks = of_part.surface->places.specks;
  }
  verdict.answer = answer_of(verdict.unresolved, verdict.print);
  verdict.words = beginning(verdict.answer) + reasons(verdict);
  return verdict;
}

Verdict leave_open(Verdict verdict, const std::string& why) {
  verdict.words =
      why + (verdict.answer == Answer::not_judged ? ": no voxel is wholly inside the part" : reasons(verdict));
  verdict.answer = Answer::left_open;
  return verdict;
}

std::string grey_words(const model::DoseMetrics& figures, std::optional<double> band) {
  return std::string(figures.ver == 0 ? "met: " : "not met: ") + percent(1 - figures.ver, 4) + " of " +
         std::to_string(voxels(figures)) + " voxels are within " +
         (band ? format_number(*band, 3) + " of the target" : "their bands around the target") + ", the farthest is " +
         format_number(figures.ipdr, 3) + " away";
}

}  // namespace vam::verdict
