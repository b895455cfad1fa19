// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/exposure.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "io/settings/printer_match.hpp"
#include "model/metadata.hpp"
#include "optics/projector_frames.hpp"
#include "resin/absolute_dose.hpp"

namespace vam::session {

namespace {

/// Critical doses of a turn in full light, per radian.
std::optional<double> rate_of(const model::Printer& printer) {
  const auto dose = resin::dose_per_radian_mj_cm3(printer);
  return dose ? std::optional(*dose / *printer.resin.critical_dose_mj_cm3) : std::nullopt;
}

/// Of the printer in use, with the resin that the stack was planned for where it knows none.
std::optional<double> rate_for(model::Printer printer, const std::optional<model::Printer>& planned_for) {
  if (planned_for && !printer.resin.critical_dose_mj_cm3) printer.resin = planned_for->resin;
  return rate_of(printer);
}

}  // namespace

Exposure exposure_of(const model::StackInfo& info, const model::Printer& printer, double peak,
                     const GivenExposure& given) {
  std::optional<model::Printer> planned_for;
  const auto own = info.extra.find("vam:printer");
  if (own != info.extra.end()) planned_for = io::parse_settings(own->second, "vam:printer");
  const auto rate = rate_for(printer, planned_for);
  auto turns = model::shown_turns(info.extra);
  auto full_scale = model::full_scale(info.extra);
  const auto threshold = model::threshold_dose(info.extra);
  std::optional<double> needed;  // turns times rate by full scale
  if (turns && full_scale && rate) {
    needed = *turns / *full_scale * (planned_for ? rate_of(*planned_for) : std::nullopt).value_or(*rate);
  } else if (rate && threshold && *threshold > 0 && model::repeat(info.poses)) {
    needed = 1 / *threshold;
    const double whole = optics::turns_of(info);
    turns = whole * std::ceil(*needed * full_scale.value_or(peak) / (*rate * whole) * (1 - 1e-9));
    if (!full_scale) full_scale = *turns * *rate / *needed;
  }
  Exposure exposure;
  exposure.turns = optics::turns_to_show(info, given.turns, turns.value_or(printer.stage.turns));
  exposure.full_scale = given.full_scale.value_or(full_scale.value_or(peak)) / given.multiplier;
  // What is brighter than full intensity is shown at that, and the brightest places lack it first.
  if (needed) exposure.share = exposure.turns * *rate / (std::max(exposure.full_scale, peak) * *needed);
  return exposure;
}

void require_dose(const Exposure& exposure, bool accepted, const std::string& name) {
  if (!exposure.share || std::abs(*exposure.share - 1) < 1e-3) return;
  const std::string turns = format_number(exposure.turns, 4);
  const std::string what = name + ": " + turns + (turns == "1" ? " turn gives " : " turns give ") +
                           format_number(*exposure.share, 2) + " of the planned dose, which " +
                           format_number(exposure.turns / *exposure.share, 4) + " turns reach";
  const bool near = *exposure.share >= 0.9 && *exposure.share <= 1.1;
  if (!near && !accepted) throw Error{Fault::data, what + "; omit what differs from the plan, or give --accept-dose"};
  warn(what);
}

std::string how_to_show(bool planned, const std::string& sinogram) {
  if (planned) return "; to show it: vam-project " + sinogram + " -o print.mkv";
  return "; dose and time are relative: vam-calibrate critical-dose measures resin.critical_dose_mj_cm3";
}

}  // namespace vam::session
