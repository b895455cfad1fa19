// SPDX-License-Identifier: GPL-3.0-or-later
// The factor by which a target is stretched along z [formats: Attributes of volumes and prints].
#pragma once

#include <optional>
#include <string>

#include "base/printable.hpp"
#include "base/text.hpp"

namespace vam::model {

inline constexpr const char* stretch_name = "vam:stretch_z";
inline constexpr double least_stretch = 0.1, most_stretch = 10;

/// None where the text is not a factor that vam-slice takes.
[[nodiscard]] inline std::optional<double> parse_stretch(const std::string& text) {
  const auto factor = parse_number(text);
  return factor && *factor >= least_stretch && *factor <= most_stretch ? factor : std::nullopt;
}

/// "states vam:stretch_z 'nan', ..."; empty where it is a factor.
[[nodiscard]] inline std::string stretch_objection(const std::string& text) {
  if (parse_stretch(text)) return "";
  return "states vam:stretch_z " + excerpt(text) + ", which is not a factor of 0.1 to 10; slice it again";
}

}  // namespace vam::model
