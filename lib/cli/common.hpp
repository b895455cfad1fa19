// SPDX-License-Identifier: GPL-3.0-or-later
// Options that several tools share: one spelling, one help text. None is part of App::job(): of the printer its TOML
// text is recorded, which is complete.
#pragma once

#include <string>
#include <vector>

#include "cli/app.hpp"

namespace vam::cli {

/// -o/--output FILE, "-" (stdout) by default.
App& add_output(App& app, std::string& output);

/// --printer FILE and --set key=value; hand both to io::load_printer.
struct PrinterOptions {
  std::string file;               // empty: $VAM_PRINTER, ./printer.toml, or the embedded default
  std::vector<std::string> sets;  // "vial.radius_mm=12"
  bool print = false;             // --print-printer
};
inline constexpr const char* printer_flag = "--printer";
App& add_printer(App& app, PrinterOptions& options);
/// " --printer FILE --set KEY=VALUE": as they were given, for another command.
[[nodiscard]] std::string printer_words(const PrinterOptions& options);

/// --report FILE.json
App& add_report(App& app, std::string& report);

/// --threads N (0 = all cores), applied while parsing.
App& add_threads(App& app);

/// --half, --compression for tools that write stacks.
App& add_stack_output(App& app, bool& half, std::string& compression);

}  // namespace vam::cli
