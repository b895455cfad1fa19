// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/slices.hpp"

#include "base/error.hpp"

namespace vam::session {

model::ImageChoice slices_named(const std::string& text) {
  if (const auto choice = model::parse_choice(text)) return *choice;
  throw Error{Fault::usage, "--slices: '" + text +
                                "' is neither a range FROM:TO with FROM < TO, such as 0:64, nor a share I/N, such as "
                                "1/4"};
}

model::ImageRange slices_among(const std::string& text, int count, const std::string& name, int unit) {
  if (const auto range = slices_named(text).among(count, unit)) return *range;
  throw Error{Fault::data, name + ": has " + std::to_string(count) + " slices, too few for --slices " + text};
}

}  // namespace vam::session
