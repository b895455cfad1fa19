// SPDX-License-Identifier: GPL-3.0-or-later
// What volumes and stacks state in their metadata [formats: Attributes of volumes and prints].
#pragma once

#include <map>
#include <optional>
#include <string>

#include "model/mesh.hpp"
#include "model/part_surface.hpp"

namespace vam::model {

using Metadata = std::map<std::string, std::string>;

/// Empty if it is not stated.
[[nodiscard]] std::string stated_text(const Metadata& metadata, const std::string& name);
/// Empty if it is not stated, or not a number.
[[nodiscard]] std::optional<double> stated_number(const Metadata& metadata, const std::string& name);

inline constexpr const char* stretch_name = "vam:stretch_z";
inline constexpr double least_stretch = 0.1, most_stretch = 10;
/// Why the text is not a factor that vam-slice takes, "states vam:stretch_z 'nan', ..."; empty where it is one.
[[nodiscard]] std::string stretch_objection(const std::string& text);
/// The factor by which vam-slice stretched the part along z; 1 if it is not stated. Validated on reading.
[[nodiscard]] double stretch_z(const Metadata& metadata);
/// Heights of the part instead of those of the stretched volume.
void unstretch(TriangleSoup& mesh, const Metadata& metadata);

/// States what the part's own surface shows.
void state_surface(Metadata& metadata, const PartSurface& surface);
/// Empty if missing or malformed.
[[nodiscard]] std::optional<PartSurface> stated_surface(const Metadata& metadata);

/// The dose at which the projections print, in the unit of the dose.
[[nodiscard]] std::optional<double> threshold_dose(const Metadata& metadata);
/// What a relative dose of 1 is, in mJ/cm3.
[[nodiscard]] std::optional<double> dose_unit_mj_cm3(const Metadata& metadata);

}  // namespace vam::model
