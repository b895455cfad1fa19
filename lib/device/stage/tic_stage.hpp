// SPDX-License-Identifier: GPL-3.0-or-later
// A stepper motor behind a Pololu Tic (T500, T825, T834, T249, 36v4, N825) [devices §3.2].
#pragma once

#include <memory>

#include "device/port/usb_link.hpp"
#include "device/stage/stage.hpp"

namespace vam::device {

/// steps_per_deg: microsteps of the motor a degree of the stage, gears included; negative turns the other way. The Tic
/// stops by itself when it hears nothing for its command time-out (1 s unless set otherwise).
[[nodiscard]] std::unique_ptr<Stage> make_tic_stage(std::unique_ptr<UsbLink> link, Clock& clock, double steps_per_deg,
                                                    Guardian* guardian);

}  // namespace vam::device
