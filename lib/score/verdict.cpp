// SPDX-License-Identifier: GPL-3.0-or-later
#include "score/verdict.hpp"

#include "base/json.hpp"
#include "base/text.hpp"
#include "model/unresolved.hpp"

namespace vam::score {

namespace {

std::int64_t voxels(const model::DoseMetrics& m) { return m.part + m.void_; }

std::string margin(const model::DoseMetrics& m) { return (m.pw > 0 ? "+" : "") + format_number(m.pw, 3); }

bool holds_threshold(const Verdict& verdict) {
  const auto& t = verdict.threshold;
  return !t || (verdict.whole.max_void < *t && *t <= verdict.whole.min_part);
}

}  // namespace

bool prints(const Verdict& verdict) { return verdict.whole.pw > 0 && holds_threshold(verdict); }

bool is_unresolved(const Verdict& verdict) { return verdict.unresolved > model::much_unresolved; }

std::string words(const Verdict& verdict) {
  const std::int64_t cut = voxels(verdict.with_cut) - voxels(verdict.whole);
  std::string line = !prints(verdict) ? "will not print" : is_unresolved(verdict) ? "may print" : "will print";
  if (!holds_threshold(verdict)) {
    line += " at the threshold of " + format_number(*verdict.threshold, 3) + " (void up to " +
            format_number(verdict.whole.max_void, 3) + ", part at least " + format_number(verdict.whole.min_part, 3) +
            ")";
  }
  line += ": process window " + margin(verdict.whole) + " of the largest dose, VER " +
          format_number(verdict.whole.ver, 3) + " (" + std::to_string(voxels(verdict.whole)) + " voxels)";
  if (cut > 0) {
    line += "; including the " + std::to_string(cut) + " voxels cut by the surface: process window " +
            margin(verdict.with_cut) + ", VER " + format_number(verdict.with_cut.ver, 3);
  }
  if (is_unresolved(verdict)) {
    line += "; walls and gaps too thin for the voxels are not judged: " + format_number(100 * verdict.unresolved, 2) +
            " % of the part; smaller voxels resolve them";
  }
  if (verdict.seconds) line += "; duration " + format_number(*verdict.seconds, 4) + " s";
  return line;
}

void add_to(Json& figures, const Verdict& verdict) {
  figures["verdict"] = words(verdict);
  figures["with_surface"] = {{"voxels", voxels(verdict.with_cut)},
                             {"ver", verdict.with_cut.ver},
                             {"pw", verdict.with_cut.pw},
                             {"iou", verdict.with_cut.iou}};
}

}  // namespace vam::score
