// SPDX-License-Identifier: GPL-3.0-or-later
// The constructors behind open_stage(). The guardian may be null in tests.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "device/port/usb_link.hpp"
#include "device/stage/private/gcs_link.hpp"
#include "device/stage/stage.hpp"

namespace vam::device {

/// A PI controller with one rotation stage, e.g. C-863 with M-060.PD [devices §3.1]. axis is the controller's name of
/// it, "1" unless renamed.
[[nodiscard]] std::unique_ptr<Stage> make_gcs_stage(std::unique_ptr<Port> port, Clock& clock, GcsSettings settings,
                                                    const std::string& axis, Guardian* guardian);

/// Opens the serial port at `baud`, or at the first of 115200, 38400, 19200, 9600 at which "*IDN?" is answered. Throws
/// Fault::busy when none is.
[[nodiscard]] std::unique_ptr<Port> find_gcs(const std::string& path, std::optional<int> baud, Clock& clock,
                                             const GcsSettings& settings);

/// Throws Fault::usage when the controller tells its axes and this is none of them. One that does not know the question
/// is taken as it is; the error it then has pending is not cleared.
void require_axis(GcsLink& link, const std::string& axis);

/// A stepper motor behind a Pololu Tic (T500, T825, T834, T249, 36v4, N825) [devices §3.2]. steps_per_deg: microsteps
/// of the motor a degree of the stage, gears included; negative turns the other way. The Tic stops by itself when it
/// hears nothing for its command time-out (1 s unless set otherwise).
[[nodiscard]] std::unique_ptr<Stage> make_tic_stage(std::unique_ptr<UsbLink> link, Clock& clock, double steps_per_deg,
                                                    Guardian* guardian);

/// A rotation axis driven by GRBL 1.1, one unit per degree [devices §3.3]. axis: X, Y or Z (0, 1, 2). Motions are jogs,
/// which 0x85 cancels without losing the position. Angles are machine positions plus an offset that lives as long as
/// this object. home_here: a board without homing switches, whose homing takes the present position as the zero;
/// Fault::data from one that has switches ($22).
[[nodiscard]] std::unique_ptr<Stage> make_grbl_stage(std::unique_ptr<Port> port, Clock& clock, int axis,
                                                     Guardian* guardian, bool home_here = false);

struct ZaberSettings {
  int address = 1;           // of the device in its chain, 1 to 99
  int axis = 1;              // of the device, 1 to 9
  double steps_per_deg = 0;  // microsteps; 0: limit.cycle.dist of the device over 360
};

/// A Zaber rotary stage or controller in Zaber's ASCII protocol, firmware 6 and 7 [devices §3.4]. Angles are positions
/// of the device plus an offset that lives as long as this object: nothing is written to its memory, but for the speed
/// (maxspeed) of firmware older than 7.25, which takes none with a motion. Throws Fault::data when neither the settings
/// nor the device tell the microsteps of a turn.
[[nodiscard]] std::unique_ptr<Stage> make_zaber_stage(std::unique_ptr<Port> port, Clock& clock,
                                                      const ZaberSettings& settings, Guardian* guardian);

}  // namespace vam::device
