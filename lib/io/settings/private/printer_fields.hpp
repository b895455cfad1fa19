// SPDX-License-Identifier: GPL-3.0-or-later
// The one table of the printer file's keys, which drives parsing, validation and printing; and its first and last line.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "model/printer.hpp"

namespace vam::io {

/// Where a setting lives in the Printer; the alternative is its type in the file.
using Slot = std::variant<int*, double*, std::optional<double>*, bool*, std::string*>;

struct PrinterField {
  const char* section;
  const char* key;
  Slot (*slot)(model::Printer&);
  std::string comment;  // meaning and unit
  double low = -1e300;  // allowed numbers, low itself included unless open_low
  double high = 1e300;
  bool open_low = false;
  std::vector<std::string> words{};    // when not empty: the only values allowed, as text
  std::vector<std::string> schemes{};  // when not empty: what a device may begin with, before its colon
};

/// All fields, grouped by section in the order in which the file is printed.
[[nodiscard]] std::span<const PrinterField> printer_fields();

/// The sections in that order.
[[nodiscard]] std::vector<std::string> section_names();

/// A printer at its defaults but for the axis, whose place is not a number until it is set.
[[nodiscard]] model::Printer without_axis();
/// Fills in what is not set: the axis, in the middle of the columns and rows, and the absorption that the initiator
/// states.
void settle(model::Printer& printer);

/// "vial.radius_mm"
[[nodiscard]] std::string dotted_name(const PrinterField& field);

/// Why the number or the word in the slot is not allowed: "must be above 0"; empty when it is.
[[nodiscard]] std::string objection(const PrinterField& field, const Slot& slot);

/// The same for the digits of a whole number that an int cannot hold.
[[nodiscard]] std::string objection_to_whole(const PrinterField& field, const std::string& digits);

/// What no single field can tell (a wall thicker than the vial, a lens inside it): the first contradiction in words
/// that name both settings and their numbers; empty when there is none.
[[nodiscard]] std::string contradiction(const model::Printer& printer);

/// The first and the last line of a printer file that these tools write, and the last one of any that says it is whole.
inline constexpr std::string_view printer_head =
    "# Printer settings of the VAM tools, to the line \"# end of the settings\".";
inline constexpr std::string_view printer_end = "# end of the settings";

/// Throws Fault::data where a text has the first line, and not the last one.
void require_own_end(std::string_view text, const std::string& subject);

}  // namespace vam::io
