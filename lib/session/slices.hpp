// SPDX-License-Identifier: GPL-3.0-or-later
// --slices FROM:TO or I/N.
#pragma once

#include <string>

#include "model/piece.hpp"

namespace vam::session {

/// Throws Fault::usage for what is neither.
model::ImageChoice slices_named(const std::string& text);

/// Of a stack of so many images called `name`. Throws Fault::data where it has too few.
[[nodiscard]] model::ImageRange slices_among(const std::string& text, int count, const std::string& name, int unit = 1);

}  // namespace vam::session
