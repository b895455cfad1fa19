// SPDX-License-Identifier: GPL-3.0-or-later
// The printer that a tool works for.
#pragma once

#include <string>

#include "base/image.hpp"
#include "cli/common.hpp"
#include "model/metadata.hpp"
#include "model/printer.hpp"
#include "resin/response.hpp"

namespace vam::session {

/// As --printer and --set say. Throws as io::load_printer does.
[[nodiscard]] model::Printer load_printer(const cli::PrinterOptions& options);

enum class Role { judge, instrument };
/// The printer of a file with these facts: the one that it states (vam:printer), with --set, in whatever folder it is
/// judged. A printer file that is given or found is named in a warning, which begins with `name`, where it differs; a
/// given one counts. For an instrument, which frames are made for, it counts also where it is found, and devices, their
/// limits and calibration are never those of the facts. Throws as load_printer() does, which it is for a file that
/// states none.
[[nodiscard]] model::Printer printer_of(const cli::PrinterOptions& options, const model::Metadata& facts,
                                        const std::string& name, Role role = Role::judge);

/// Writes `printer` as commented TOML to `output` if --print-printer is given; returns whether it did.
bool print_printer(const cli::PrinterOptions& options, const model::Printer& printer, const std::string& output);
/// The same where nothing else has needed the printer yet.
bool print_printer(const cli::PrinterOptions& options, const std::string& output = "-");

/// Throws Fault::usage for an option that has no effect with the settings of this printer (cli::App::only_with).
void require_settings(const cli::App& app, const model::Printer& printer);

/// The response of its projector: as measured (projector.response), or else linear from min_intensity to max_intensity.
/// Throws as io::read_response does.
[[nodiscard]] resin::Response response_of(const model::Projector& projector);

/// Its flat field, the light of every pixel at one grey level, the least 1; empty where it is even. Throws Fault::data
/// for one of another size, and where a pixel has less than a fifth of the brightest one's light.
[[nodiscard]] Image flat_of(const model::Projector& projector);

}  // namespace vam::session
