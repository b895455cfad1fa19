// SPDX-License-Identifier: GPL-3.0-or-later
// GenICam cameras as their makers document them.
#pragma once

#include <string>
#include <vector>

#include "device/camera/stamp.hpp"

namespace vam::sim {

struct SimMaker {
  std::string name;           // of an option
  std::string vendor, model;  // as the camera tells them
  device::StampMoment stamp;  // of the exposure, that its frames bear
  std::string nodes = {};     // GenICam features that others have not
};

/// Those that there are; the first is Aravis' fake camera itself.
[[nodiscard]] std::vector<std::string> sim_maker_names();

/// Throws Fault::usage for one that is not known.
[[nodiscard]] const SimMaker& sim_maker(const std::string& name);

}  // namespace vam::sim
