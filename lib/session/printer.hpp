// SPDX-License-Identifier: GPL-3.0-or-later
// The printer that a tool works for.
#pragma once

#include <string>

#include "cli/common.hpp"
#include "model/printer.hpp"
#include "resin/response.hpp"

namespace vam::session {

/// As --printer and --set say. Throws as io::load_printer does.
[[nodiscard]] model::Printer load_printer(const cli::PrinterOptions& options);

/// Writes `printer` as commented TOML to `output` if --print-printer is given; returns whether it did.
bool print_printer(const cli::PrinterOptions& options, const model::Printer& printer, const std::string& output);
/// The same where nothing else has needed the printer yet.
bool print_printer(const cli::PrinterOptions& options);

/// The response of its projector: as measured (projector.response), or else linear from min_intensity to max_intensity.
/// Throws as io::read_response does.
[[nodiscard]] resin::Response response_of(const model::Projector& projector);

}  // namespace vam::session
