// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated Zaber rotary stage with its controller, in Zaber's ASCII protocol.
#pragma once

#include <memory>

#include "sim/controllers/gcs.hpp"

namespace vam::sim {

/// Takes motor, latency, speed, limits, address and log settings from the same struct as the GCS controller; faults are
/// garbage, truncated, late, silent, wrong-sender and error at a command's words ("get pos", "move abs", "home",
/// "warnings", "" for the question without words), stall: the stage is held fast and reports it; unplug and power-loss
/// anywhere. Without a reference it takes no absolute motion, and its position counts from where it stood at power-on.
[[nodiscard]] std::unique_ptr<SimDevice> make_sim_zaber(const SimGcsSettings& settings, double now_s, SimLog log);

}  // namespace vam::sim
