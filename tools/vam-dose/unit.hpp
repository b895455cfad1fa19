// SPDX-License-Identifier: GPL-3.0-or-later
// The unit of doses: relative, or mJ/cm3, of a turn or of a whole print.
#pragma once

#include <optional>
#include <string>

#include "base/text/json_fwd.hpp"
#include "io/vdb/vdb.hpp"
#include "model/printer.hpp"
#include "score/exposure.hpp"
#include "vam-dose/expose.hpp"
#include "vam-dose/options.hpp"

namespace vam::dose_tool {

struct Unit {
  bool absolute = false;
  double turn = 1;         // multiplies the dose of one turn
  double showings = 1;     // and that of the whole print
  double relative = 1;     // what a relative dose of 1 becomes
  double print_turns = 0;  // of the print whose dose it is; 0: it is the dose of a turn
  std::string dose_of;     // which print: shown, stated or planned [formats: Attributes of volumes and prints]
  double full_turns = 0;   // of full intensity
  double print_s = 0;
  std::optional<score::ExposurePlan> plan;  // of --exposure-plan
};

/// Absolute when the resin has a critical dose, and then of the print that the light was planned for. Throws
/// Fault::data when an exposure is to be planned for a target without part or void; warns when there is no process
/// window.
[[nodiscard]] Unit unit_of(const Exposed& exposed, const Options& options, const model::Printer& printer,
                           const model::StackInfo& light);

/// The volume in that unit.
void convert(io::SparseVolume& volume, const Unit& unit);

/// For --report.
[[nodiscard]] Json figures(const Exposed& exposed, const Unit& unit, const Options& options,
                           const model::Printer& printer, const model::StackInfo& light);

}  // namespace vam::dose_tool
