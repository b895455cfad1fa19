// SPDX-License-Identifier: GPL-3.0-or-later
// The command lines of a print: what vam-print runs, and what runs by hand.
#pragma once

#include <string>
#include <vector>

#include "device/os/child.hpp"
#include "vam-print/run.hpp"

namespace vam::print_tool {

/// Before anything moves, for the name under which what they say is kept. Settings are those of `printer`.
[[nodiscard]] Command check_records(const Run& run, const std::vector<std::string>& more);
[[nodiscard]] Command freeze(const Run& run, const std::string& file, bool accept_printer);
[[nodiscard]] Command identify(const std::string& name, const std::string& tool, const std::string& printer);
[[nodiscard]] Command plan_light(const Run& run, const std::string& printer);
[[nodiscard]] Command plan_motion(const Run& run, const std::string& printer);
[[nodiscard]] Command try_metrology(const Run& run, const std::string& printer);

/// Of the print itself, those who read first.
[[nodiscard]] std::vector<Command> tools_of(const Run& run);
/// Beside it: new projections, the line on a terminal and the page.
[[nodiscard]] Command renew(const Run& run);
[[nodiscard]] Command watch(const Run& run);

/// All of them as a shell takes them, from an empty folder of the run to its end.
[[nodiscard]] std::vector<std::string> lines_by_hand(const Run& run);

/// Turns of the stage: those with light, and dark ones after them.
[[nodiscard]] int all_turns(const Run& run);

}  // namespace vam::print_tool
