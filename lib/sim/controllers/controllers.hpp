// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated controllers on a serial line: rotation stages and the relay of a lamp, with their faults.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/os/address.hpp"
#include "sim/controllers/device.hpp"
#include "sim/controllers/motor.hpp"

namespace vam::sim {

/// One thing that goes wrong: at the n-th time (from 1) that the command (POS?, MOV, #7, ...) arrives.
/// garbage: random bytes instead of the answer · truncated: half the answer and no LF · late: 3 s later · silent: never
/// wrong-sender: as if controller 7 had answered · error: the command is refused · unplug: the cable is pulled, motion
/// goes on · power-loss: the controller dies and the stage coasts to a stop · block: the
/// stage is held fast while the controller talks on · stall: the same, and a Zaber controller reports it.
struct SimFault {
  std::string kind;
  std::string command;
  int occurrence = 1;
};

/// "truncated@POS?:3". Throws Fault::usage.
[[nodiscard]] SimFault parse_sim_fault(const std::string& text);

/// Of all of them; each takes what it has.
struct SimGcsSettings {
  MotorSettings motor;
  double max_speed_deg_s = 90;  // M-060.PD
  double min_deg = -36000;
  double max_deg = 36000;
  double home_deg = 17;       // where the stage stands at power-on, seen from its reference
  double latency_s = 0.0005;  // from question to answer, half of it before the controller looks at its axis
  double jitter_s = 0;        // a random part more, of either half
  std::uint64_t seed = 1;
  int address = 1;
  bool referenced = false;     // GCS: at power-on, as if an earlier user had found the reference
  bool reset_at_open = false;  // GRBL, as most boards do by the DTR line: greets, and counts from where it stands
  bool no_switches = false;    // GRBL: no homing switches ($22=0)
  bool inches = false;         // GRBL: reports inches ($13=1), as an earlier owner left it
  bool old_firmware = false;   // Zaber: 6.28, which takes no speed with a motion
  double log_period_s = 0.01;  // of the true angle, while the stage moves
  std::vector<SimFault> faults;
};

/// By the options of a device string, as of sim:?speed_error=0.01&jitter=5.
[[nodiscard]] SimGcsSettings sim_settings(const device::Address& address);

/// Writes each line to the file as it comes; nothing when path is empty.
[[nodiscard]] SimLog file_sim_log(const std::string& path);

/// A PI C-863.
[[nodiscard]] std::unique_ptr<SimDevice> make_sim_gcs(const SimGcsSettings& settings, double now_s, SimLog log);

/// A GRBL 1.1 board with the stage on axis X. Faults are garbage, truncated, late, silent and error at "?", "$J", "$I",
/// "$$", "$H", "$X"; unplug and power-loss anywhere.
[[nodiscard]] std::unique_ptr<SimDevice> make_sim_grbl(const SimGcsSettings& settings, double now_s, SimLog log);

/// A Zaber rotary stage with its controller, in Zaber's ASCII protocol. Faults are garbage, truncated, late, silent,
/// wrong-sender and error at a command's words ("get pos", "move abs", "home", "warnings", "" for the question without
/// words), stall: the stage is held fast and reports it; unplug and power-loss anywhere. Without a reference it takes
/// no absolute motion, and its position counts from where it stood at power-on.
[[nodiscard]] std::unique_ptr<SimDevice> make_sim_zaber(const SimGcsSettings& settings, double now_s, SimLog log);

/// A dead-man relay with the firmware of [devices §7]. Its log has {"event": "closed"} and {"event": "open", "reason":
/// "order" or "heartbeat"}. Of the settings it takes latency and faults, at "?", "A", "H" and "O".
[[nodiscard]] std::unique_ptr<SimDevice> make_sim_relay(const SimGcsSettings& settings, double now_s, SimLog log);

}  // namespace vam::sim
