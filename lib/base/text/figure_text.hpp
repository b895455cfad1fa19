// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of any kind, counts among them, as tables show them.
#pragma once

#include <string>

namespace vam {

/// A whole number in full, as counts are, however many digits it has; any other as format_number() has it.
[[nodiscard]] std::string format_figure(double value, int digits = 6);

/// An aligned line "name value meaning" of a table.
[[nodiscard]] std::string figure_row(const std::string& name, double value, const std::string& meaning);

/// With so many digits behind the point: "2.50".
[[nodiscard]] std::string fixed_number(double value, int decimals);

}  // namespace vam
