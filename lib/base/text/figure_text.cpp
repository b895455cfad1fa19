// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/figure_text.hpp"

#include <cmath>
#include <cstdio>

#include "base/text/text.hpp"

namespace vam {

std::string format_figure(double value, int digits) {
  constexpr double most = 1e15;  // beyond, not every whole number is a double
  const bool whole = std::abs(value) < most && value == std::round(value);
  return whole ? std::to_string(std::llround(value)) : format_number(value, digits);
}

std::string figure_row(const std::string& name, double value, const std::string& meaning) {
  char line[200];
  std::snprintf(line, sizeof line, "%-21s %12s  %s\n", name.c_str(), format_figure(value).c_str(), meaning.c_str());
  return line;
}

std::string fixed_number(double value, int decimals) {
  char text[400];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

}  // namespace vam
