// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated dead-man relay with the firmware of [devices §7].
#pragma once

#include <memory>

#include "sim/controllers/gcs.hpp"

namespace vam::sim {

/// Its log has {"event": "closed"} and {"event": "open", "reason": "order" or "heartbeat"}. Of the settings it takes
/// latency and faults, at "?", "A", "H" and "O".
[[nodiscard]] std::unique_ptr<SimDevice> make_sim_relay(const SimGcsSettings& settings, double now_s, SimLog log);

}  // namespace vam::sim
