// SPDX-License-Identifier: GPL-3.0-or-later
// What is on the page, from the verdict to the provenance.
#pragma once

#include <string>

#include "cli/common.hpp"
#include "session/grey_target.hpp"
#include "vam-report/sources.hpp"

namespace vam::report_tool {

struct Wanted {
  std::string title;
  std::string history;  // of this command
  int sections = 0;     // of a volume, at most
  int projections = 0;  // of a stack or video, at most
  session::GreyChoice grey = {};
};

/// HTML of the body. Throws what the readers of its files throw.
[[nodiscard]] std::string content(const Sources& sources, const cli::PrinterOptions& printer, const Wanted& wanted);

}  // namespace vam::report_tool
