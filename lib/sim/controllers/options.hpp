// SPDX-License-Identifier: GPL-3.0-or-later
// Simulators are configured by options of their device string: sim:?speed_error=0.01&jitter=5&log=truth.jsonl.
#pragma once

#include <string>

#include "device/os/address.hpp"
#include "sim/controllers/gcs.hpp"

namespace vam::sim {

[[nodiscard]] SimGcsSettings sim_settings(const device::Address& address);

/// Writes each line to the file as it comes; nothing when path is empty.
[[nodiscard]] SimLog file_sim_log(const std::string& path);

}  // namespace vam::sim
