// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/figure_text.hpp"

#include <cmath>

#include "base/text/text.hpp"

namespace vam {

std::string format_figure(double value, int digits) {
  constexpr double most = 1e15;  // beyond, not every whole number is a double
  const bool whole = std::abs(value) < most && value == std::round(value);
  return whole ? std::to_string(std::llround(value)) : format_number(value, digits);
}

}  // namespace vam
