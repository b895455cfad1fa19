// SPDX-License-Identifier: GPL-3.0-or-later
// How long and how bright a sinogram is shown, and what of the planned dose that gives.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cli/common.hpp"
#include "model/metadata.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"

namespace vam::session {

struct Exposure {
  double turns = 1;
  bool planned = false;                  // the turns are those of a plan, neither given nor stage.turns
  double full_scale = 0;                 // the sinogram's value at full intensity; 0: not known
  std::optional<double> share = {};      // of the planned dose; none: the resin is not known
  std::optional<int> unused_turns = {};  // stage.turns of a file that are others than planned

  [[nodiscard]] bool as_planned() const { return share && std::abs(*share - 1) < 1e-3; }
};

/// What options say instead of the plan.
struct GivenExposure {
  std::optional<double> turns = {}, full_scale = {};
  double multiplier = 1;               // of the intensity
  std::vector<std::string> sets = {};  // --set, of which stage.turns counts where `turns` are not given
};

/// The plan that the stack `name` states (vam:shown_turns, vam:full_scale), which nothing else reads; where it states
/// its threshold alone, as joined and resampled ones do, the fewest turns in which the printer reaches the resin's
/// critical dose there, once `peak` is known, the largest value; where the resin is not known, stage.turns with the
/// peak at full intensity. peak: 0 before the light is read. Throws Fault::data for a plan that is none.
[[nodiscard]] Exposure exposure_of(const std::string& name, const model::StackInfo& info, const model::Printer& printer,
                                   double peak, const GivenExposure& given = {});

/// States a plan, in texts of one length, so that what is found last fits into a header that was written first; 0:
/// unknown. Nothing else does.
void state_exposure(model::Metadata& facts, double turns, double full_scale);
/// For the facts of other light, or of a dose.
void forget_exposure(model::Metadata& facts);

void warn_of_turns(const Exposure& exposure, const std::string& name);

/// Throws Fault::data for less than 0.9 or more than 1.1 of the planned dose, which `accepted` makes a warning; says
/// so of what else differs. `name` begins the message.
void require_dose(const Exposure& exposure, bool accepted, const std::string& name);

/// "relative without KEYS, ...": the settings that doses in mJ/cm3 lack, and how they are measured. Empty: none.
[[nodiscard]] std::string relative_without(const model::Resin& resin);
/// Behind a verdict: that, or the command that shows `sinogram`, where that is `stated`, as the stack states, to the
/// printer of this run.
[[nodiscard]] std::string how_to_show(const model::Resin& resin, bool stated, const std::string& sinogram,
                                      const cli::PrinterOptions& run);

}  // namespace vam::session
