// SPDX-License-Identifier: GPL-3.0-or-later
// Which stage a device string names.
#pragma once

#include "device/stage/stage.hpp"

namespace vam::device {

/// Opens a device of model::stage_schemes, locked for this process. guardian may be null where nobody can be killed
/// (tests in virtual time). Throws as the constructors and DeviceLock do, and Fault::usage for a bad device string.
[[nodiscard]] std::unique_ptr<Stage> open_stage(const std::string& device, Clock& clock, Guardian* guardian);

/// The devices that open_stage knows, for --help: "gcs:PATH ... or sim:".
[[nodiscard]] std::string stage_devices();

}  // namespace vam::device
