// SPDX-License-Identifier: GPL-3.0-or-later
// What determines the light of a job and the volumes that it is made for, beside its printer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/printer.hpp"
#include "model/tolerances.hpp"
#include "optimize/target/problem.hpp"

namespace vam::session {

/// The names are those of the options, and of the settings [optimize] of the printer file.
struct JobOptions : model::OptimizeSettings {
  std::string input = "-";  // begins messages about the target
  std::string geometry = "vial";
  int angles = 360;
  std::optional<int> bins;
  std::string poses;  // one of the three, or none
  std::optional<double> helix_mm;
  std::string wobble_record;
  std::optional<double> turns;                          // of the print, at full grey
  std::optional<model::Tolerances> printer_tolerances;  // that the light faces
  optimize::Demands demands;                            // target constraints
  std::string weights, band_volume;
  std::vector<std::string> delivered;  // doses of the resin before this light
  std::string void_rule = "met";

  [[nodiscard]] bool in_vial() const { return geometry == "vial"; }
};

}  // namespace vam::session
