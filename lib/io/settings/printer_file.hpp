// SPDX-License-Identifier: GPL-3.0-or-later
// The printer file: the instrument's settings as TOML, read strictly.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/printer.hpp"

namespace vam::io {

/// Calibration records (calibration_record.hpp) stand above the file and below --set. Whoever makes them must not be
/// stopped by old ones.
enum class Records { apply, ignore };

/// The settings in force. Of these the first that exists is read: `file` (when not empty; names of presets, else a
/// file), $VAM_PRINTER, ./printer.toml, else the embedded default, the printer of [RAY21]. Then come the current
/// calibration records of calibration.folder, and then each of `sets`, "vial.radius_mm=12", overrides one setting; a
/// text needs no quotes. Relative files and folders in a file are taken relative to it. Throws Error: no_input (file
/// missing), usage (an impossible --set), data (not TOML, unknown key, wrong type, impossible value; with file, line
/// and the nearest known key; a calibration record that is stale or of another instrument).
[[nodiscard]] model::Printer load_printer(const std::string& file, const std::vector<std::string>& sets,
                                          Records records = Records::apply);

/// "opencal,vial-16,dudma": whether all of these are presets, which need no file; all that there are; a text that lists
/// them with every value and its source.
[[nodiscard]] bool is_preset(const std::string& names);
[[nodiscard]] std::vector<std::string> preset_names();
[[nodiscard]] std::string preset_list();

/// What presets set, as --set does, the settings that they should set and nobody published, and both as comments for a
/// printer file. Throws Fault::usage for two of a kind, and for a vial that cannot be computed.
struct PresetSettings {
  std::vector<std::string> sets, unpublished;
  std::string comment;
};
[[nodiscard]] PresetSettings preset_settings(const std::string& names);

/// Settings from TOML text, absent ones at their defaults, then each of `sets`. `subject` begins every message. Throws
/// Fault::data, and Fault::usage for an impossible one of `sets`.
[[nodiscard]] model::Printer parse_printer(std::string_view toml, const std::string& subject,
                                           const std::vector<std::string>& sets = {});

/// Whether a text has the heading of one of its sections, right or wrong as the rest may be.
[[nodiscard]] bool has_printer_section(std::string_view text);

/// By what a text that reads well looks as if its end was cut off, and what to do: "ends within a line, as if it was
/// cut off, without [bath], [resin]; complete its last line". Empty where nothing says so, as of the last line of what
/// these tools write, which anybody may add, or of a few settings.
[[nodiscard]] std::string sign_of_cut(std::string_view text);

/// Commented TOML with every setting; parses back to the same settings, number for number.
[[nodiscard]] std::string printer_toml(const model::Printer& printer);

/// Whether this setting, "resin.psf_mm", is there and neither 0, false nor empty. Throws Fault::bug for no setting.
[[nodiscard]] bool has_setting(const model::Printer& printer, const std::string& name);

/// The settings as they count in every folder, complete by themselves: the records in force are in them, files are
/// named by their whole paths.
[[nodiscard]] model::Printer frozen(model::Printer printer);

/// What of frozen() differs from the embedded default, in the form of --set: "projector.columns=1920
/// vial.radius_mm=12"; "default" where nothing does. For the metadata vam:printer.
[[nodiscard]] std::string printer_settings(const model::Printer& printer);

/// Every setting that is not the same, in the order of the file: "vial.radius_mm 12.7, now 12.72".
[[nodiscard]] std::vector<std::string> changed_settings(model::Printer then, model::Printer now);

}  // namespace vam::io
