// SPDX-License-Identifier: GPL-3.0-or-later
// Everything off, whatever state its tools are in [devices §7].
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"

namespace vam::device {

struct Switched {
  std::string kind;        // stage, light, relay or display
  std::string device;      // the device string; of a display the name of its lock
  std::string state = {};  // that it is in now: "stopped", "in standby", "open", "dark"; empty: see problem
  std::string problem = {};
  Fault fault = Fault::busy;  // of the problem
};

/// The light engines on USB, and the displays that are in use: what can be found without a printer file.
[[nodiscard]] std::vector<Switched> find_lit();

/// Stops stages, puts light engines into standby, opens relays, all read back, and ends what shows an image. All at
/// once, each in a process of its own, at most 6 s: none keeps the others from it. A tool that uses a device is asked
/// to end (SIGTERM), and killed after 2 s, as its guardian is; another call of this is waited for (6 s). Simulators
/// inside a tool (sim:) end with it. Fills in state or problem; never throws what a device throws. For a process
/// without threads.
void switch_off(std::vector<Switched>& devices);

}  // namespace vam::device
