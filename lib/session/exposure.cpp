// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/exposure.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/settings/printer_match.hpp"
#include "optics/projector_frames.hpp"
#include "resin/absolute_dose.hpp"

namespace vam::session {

namespace {

constexpr const char* turns_name = "vam:shown_turns";
constexpr const char* full_scale_name = "vam:full_scale";
constexpr const char* unknown = "unknown";

std::string late_text(double value) {
  constexpr std::size_t length = 16;
  std::string text = value > 0 ? format_number(value, 9) : unknown;
  return text.append(length - text.size(), ' ');
}

std::optional<double> stated(const std::string& name, const model::Metadata& facts, const char* fact) {
  const auto found = facts.find(fact);
  const std::string text = found == facts.end() ? unknown : trimmed(found->second);
  if (text == unknown) return std::nullopt;
  const auto value = parse_number(text);
  constexpr double most = 1e6;
  if (value && *value > 0 && *value <= most) return value;
  throw Error{Fault::data, name + ": the projections state " + fact + " " + excerpt(text) +
                               ", which is not above 0 and at most 1e6; compute them again"};
}

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

bool sets_turns(const std::vector<std::string>& sets) {
  return std::any_of(sets.begin(), sets.end(),
                     [](const auto& one) { return trimmed(one.substr(0, one.find('='))) == "stage.turns"; });
}

}  // namespace

Exposure exposure_of(const std::string& name, const model::StackInfo& info, const model::Printer& printer, double peak,
                     const GivenExposure& given) {
  std::optional<model::Printer> planned_for;
  const auto own = info.extra.find("vam:printer");
  if (own != info.extra.end()) planned_for = io::parse_settings(own->second, name + ": vam:printer");
  const auto rate = rate_for(printer, planned_for);
  auto turns = stated(name, info.extra, turns_name);
  auto full_scale = stated(name, info.extra, full_scale_name);
  const auto threshold = model::threshold_dose(info.extra);
  std::optional<double> needed;  // turns times rate by full scale
  if (turns && full_scale && rate) {
    needed = *turns / *full_scale * (planned_for ? rate_of(*planned_for) : std::nullopt).value_or(*rate);
  } else if (rate && threshold && *threshold > 0 && peak > 0 && model::repeat(info.poses)) {
    needed = 1 / *threshold;
    const double whole = optics::turns_of(info);
    turns = whole * std::ceil(*needed * full_scale.value_or(peak) / (*rate * whole) * (1 - 1e-9));
    if (!full_scale) full_scale = *turns * *rate / *needed;
  }
  Exposure exposure;
  const int of_stage = printer.stage.turns;
  const bool by_stage = !given.turns && info.poses.empty() && sets_turns(given.sets);
  const auto given_turns = by_stage ? std::optional<double>(of_stage) : given.turns;
  exposure.planned = turns && !given_turns;
  exposure.turns = optics::turns_to_show(info, given_turns ? given_turns : turns, of_stage);
  if (needed && !given.turns && of_stage != model::Printer{}.stage.turns && of_stage != exposure.turns)
    exposure.unused_turns = of_stage;
  exposure.full_scale = given.full_scale.value_or(full_scale.value_or(peak)) / given.multiplier;
  // What is brighter than full intensity is shown at that, and the brightest places lack it first.
  if (needed) exposure.share = exposure.turns * *rate / (std::max(exposure.full_scale, peak) * *needed);
  return exposure;
}

void state_exposure(model::Metadata& facts, double turns, double full_scale) {
  facts[turns_name] = late_text(turns);
  facts[full_scale_name] = late_text(full_scale);
}

void forget_exposure(model::Metadata& facts) {
  facts.erase(turns_name);
  facts.erase(full_scale_name);
}

void warn_of_turns(const Exposure& exposure, const std::string& name) {
  if (!exposure.unused_turns) return;
  const std::string unused = std::to_string(*exposure.unused_turns);
  warn(name + ": is planned for " + format_number(exposure.turns, 4) + " turns, and stage.turns " + unused +
       " is not used; --set stage.turns=" + unused + " uses it");
}

void require_dose(const Exposure& exposure, bool accepted, const std::string& name) {
  warn_of_turns(exposure, name);
  if (!exposure.share || exposure.as_planned()) return;
  const std::string turns = format_number(exposure.turns, 4);
  const std::string what = name + ": " + turns + (turns == "1" ? " turn gives " : " turns give ") +
                           format_number(*exposure.share, 4) + " of the planned dose, which " +
                           format_number(exposure.turns / *exposure.share, 4) + " turns reach";
  const bool near = *exposure.share >= 0.9 && *exposure.share <= 1.1;
  if (!near && !accepted) throw Error{Fault::data, what + "; omit what differs from the plan, or give --accept-dose"};
  warn(what);
}

std::string relative_without(const model::Resin& resin) {
  std::vector<std::string> keys;
  if (!(resin.absorption_per_mm > 0)) keys.emplace_back("resin.absorption_per_mm");
  if (!resin.critical_dose_mj_cm3) keys.emplace_back("resin.critical_dose_mj_cm3");
  return keys.empty() ? "" : "relative without " + join(keys, " and ") + ", which vam-calibrate cure-depth measures";
}

std::string how_to_show(const model::Resin& resin, bool stated, const std::string& sinogram,
                        const cli::PrinterOptions& run) {
  const std::string relative = relative_without(resin);
  if (!relative.empty()) return "; dose and time are " + relative;
  return stated ? "; to show it: vam-project " + cli::quoted(sinogram) + cli::printer_words(run) + " -o print.mkv" : "";
}

}  // namespace vam::session
