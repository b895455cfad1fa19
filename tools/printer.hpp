// SPDX-License-Identifier: GPL-3.0-or-later
// The printer that a tool works for.
#pragma once

#include <string>

#include "cli/common.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/stream.hpp"

namespace vam::tool {

/// As --printer and --set say. Throws as io::load_printer does.
inline model::Printer load_printer(const cli::PrinterOptions& options) {
  return io::load_printer(options.file, options.sets);
}

/// Writes `printer` as commented TOML to `output` if --print-printer is given; returns whether it did.
inline bool print_printer(const cli::PrinterOptions& options, const model::Printer& printer,
                          const std::string& output) {
  if (options.print) io::write_text(output, io::printer_toml(printer));
  return options.print;
}

/// The same where nothing else has needed the printer yet.
inline bool print_printer(const cli::PrinterOptions& options, const std::string& output = "-") {
  return options.print && print_printer(options, load_printer(options), output);
}

}  // namespace vam::tool
