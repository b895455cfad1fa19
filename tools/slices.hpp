// SPDX-License-Identifier: GPL-3.0-or-later
// --slices FROM:TO or I/N.
#pragma once

#include <string>

#include "base/error.hpp"
#include "model/piece.hpp"

namespace vam::tool {

/// Throws Fault::usage for what is neither.
inline model::ImageChoice slices_named(const std::string& text) {
  if (const auto choice = model::parse_choice(text)) return *choice;
  throw Error{Fault::usage, "--slices: '" + text +
                                "' is neither a range FROM:TO with FROM < TO, such as 0:64, nor a share I/N, such as "
                                "1/4"};
}

/// Of a stack of so many images called `name`. Throws Fault::data where it has too few.
inline model::ImageRange slices_among(const std::string& text, int count, const std::string& name, int unit = 1) {
  if (const auto range = slices_named(text).among(count, unit)) return *range;
  throw Error{Fault::data, name + ": has " + std::to_string(count) + " slices, too few for --slices " + text};
}

}  // namespace vam::tool
