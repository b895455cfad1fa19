// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated Pololu Tic with a stage on its motor.
#pragma once

#include <memory>
#include <string>

#include "device/os/clock.hpp"
#include "device/port/usb_link.hpp"
#include "sim/controllers/device.hpp"
#include "sim/controllers/motor.hpp"

namespace vam::sim {

struct SimTicSettings {
  MotorSettings motor;
  double steps_per_deg = 100;
  bool referenced = false;       // else its position is uncertain, as after power-on
  double command_timeout_s = 1;  // without a word for so long it decelerates to a stop
  int error_bits = 0;            // of the error status; 8 is the kill switch
  // What spoils every transfer from the n-th (from 0) on: silent (time-out) · error (stall) · garbage · truncated ·
  // unplug.
  std::string fault;
  int fault_after = 0;
};

/// A link that answers as the controller would; faults show as errors of its transfers.
[[nodiscard]] std::unique_ptr<device::UsbLink> make_sim_tic(const SimTicSettings& settings, device::Clock& clock,
                                                            SimLog log);

}  // namespace vam::sim
