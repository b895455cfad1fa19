// SPDX-License-Identifier: GPL-3.0-or-later
// What is on the page, from the verdict to the provenance.
#pragma once

#include <string>

#include "cli/common.hpp"
#include "session/grey_target.hpp"
#include "vam-report/sources.hpp"

namespace vam::report_tool {

/// Kinds of files, for options.
inline constexpr const char* no_volume = "files without a volume";
inline constexpr const char* no_light = "files without a stack or video";
inline constexpr const char* no_target = "files without a target";
inline constexpr const char* no_dose = "files without a dose";

struct Wanted {
  std::string title;
  int sections = 0;     // of a volume, at most
  int projections = 0;  // of a stack or video, at most
  session::GreyChoice grey = {};
};

/// HTML of the body. Throws Fault::usage for options of what is not among the files, and what the readers of its files
/// throw.
[[nodiscard]] std::string content(const cli::App& app, const Sources& sources, const cli::PrinterOptions& printer,
                                  const Wanted& wanted);

}  // namespace vam::report_tool
