// SPDX-License-Identifier: GPL-3.0-or-later
// A Zaber rotary stage or controller in Zaber's ASCII protocol, firmware 6 and 7 [devices §3.4].
#pragma once

#include <memory>

#include "device/port/port.hpp"
#include "device/stage/stage.hpp"

namespace vam::device {

struct ZaberSettings {
  int address = 1;           // of the device in its chain, 1 to 99
  int axis = 1;              // of the device, 1 to 9
  double steps_per_deg = 0;  // microsteps; 0: limit.cycle.dist of the device over 360
};

/// Angles are positions of the device plus an offset that lives as long as this object: nothing is written to its
/// memory, but for the speed (maxspeed) of firmware older than 7.25, which takes none with a motion. Throws Fault::data
/// when neither the settings nor the device tell the microsteps of a turn.
[[nodiscard]] std::unique_ptr<Stage> make_zaber_stage(std::unique_ptr<Port> port, Clock& clock,
                                                      const ZaberSettings& settings, Guardian* guardian);

}  // namespace vam::device
