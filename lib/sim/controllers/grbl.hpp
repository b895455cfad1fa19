// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated GRBL 1.1 board with a rotation axis on X.
#pragma once

#include <memory>

#include "sim/controllers/gcs.hpp"

namespace vam::sim {

/// Takes motor, latency, speed and log settings from the same struct as the GCS controller; faults are garbage,
/// truncated, late, silent and error at "?", "$J", "$I", "$$", "$H", "$X"; unplug and power-loss anywhere.
[[nodiscard]] std::unique_ptr<SimDevice> make_sim_grbl(const SimGcsSettings& settings, double now_s, SimLog log);

}  // namespace vam::sim
