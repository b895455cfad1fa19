// SPDX-License-Identifier: GPL-3.0-or-later
// A PI controller with one rotation stage, e.g. C-863 with M-060.PD [devices §3.1].
#pragma once

#include <memory>

#include "device/stage/private/gcs_link.hpp"
#include "device/stage/stage.hpp"

namespace vam::device {

/// axis is the controller's name of it, "1" unless renamed.
[[nodiscard]] std::unique_ptr<Stage> make_gcs_stage(std::unique_ptr<Port> port, Clock& clock, GcsSettings settings,
                                                    const std::string& axis, Guardian* guardian);

/// Opens the serial port at `baud`, or at the first of 115200, 38400, 19200, 9600 at which "*IDN?" is answered. Throws
/// Fault::busy when none is.
[[nodiscard]] std::unique_ptr<Port> find_gcs(const std::string& path, std::optional<int> baud, Clock& clock,
                                             const GcsSettings& settings);

/// Throws Fault::usage when the controller tells its axes and this is none of them. One that does not know the question
/// is taken as it is; the error it then has pending is not cleared.
void require_axis(GcsLink& link, const std::string& axis);

}  // namespace vam::device
