// SPDX-License-Identifier: GPL-3.0-or-later
// A rotation axis driven by GRBL 1.1, one unit per degree [devices §3.3].
#pragma once

#include <memory>
#include <string>

#include "device/port/port.hpp"
#include "device/stage/stage.hpp"

namespace vam::device {

/// axis: X, Y or Z (0, 1, 2). Motions are jogs, which 0x85 cancels without losing the position. Angles are machine
/// positions plus an offset that lives as long as this object. home_here: a board without homing switches, whose homing
/// takes the present position as the zero; Fault::data from one that has switches ($22).
[[nodiscard]] std::unique_ptr<Stage> make_grbl_stage(std::unique_ptr<Port> port, Clock& clock, int axis,
                                                     Guardian* guardian, bool home_here = false);

}  // namespace vam::device
