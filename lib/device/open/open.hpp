// SPDX-License-Identifier: GPL-3.0-or-later
// Which stage, camera, display, light engine or relay a device string names.
#pragma once

#include <memory>
#include <string>

#include "device/camera/camera.hpp"
#include "device/projector/display.hpp"
#include "device/projector/light_engine.hpp"
#include "device/safety/relay.hpp"
#include "device/stage/stage.hpp"

namespace vam::device {

/// Opens a device of model::stage_schemes, locked for this process. guardian may be null where nobody can be killed
/// (tests in virtual time). Throws as the constructors and DeviceLock do, and Fault::usage for a bad device string.
[[nodiscard]] std::unique_ptr<Stage> open_stage(const std::string& device, Clock& clock, Guardian* guardian);

/// aravis:ID-or-IP (GenICam: USB3 Vision, GigE Vision), v4l2:/dev/video0, replay:DIR-or-STACK (?pace=real), sim:
/// (simulated in the tool), locked for this process. Throws as the constructors and DeviceLock do, and Fault::usage for
/// a bad device string.
[[nodiscard]] std::unique_ptr<Camera> open_camera(const std::string& device, const CameraSettings& settings,
                                                  const CameraBench& bench, Clock& clock);

/// sdl:N (window over screen N), drm:CONNECTOR (page flips without a desktop), null: (nothing is shown; vertical blanks
/// by the clock). guardian may be null in tests. Throws as the constructors and DeviceLock do, and Fault::usage for a
/// bad device string.
[[nodiscard]] std::unique_ptr<Display> open_display(const std::string& device, const DisplayMode& wanted, Clock& clock,
                                                    Guardian* guardian);

/// Does this output name a display?
[[nodiscard]] bool names_display(const std::string& output);

/// dlpc350:SERIAL or dlpc900:SERIAL (serial optional) with options current_percent, max_current_percent and leds; sim:
/// is a simulated DLPC350. max_current_percent is the instrument's cap, which the option of that name can only lower.
[[nodiscard]] std::unique_ptr<LightEngine> open_light(const std::string& device, double max_current_percent,
                                                      Guardian* guardian);

/// relay:PATH with option baud (115200), or sim:, a simulated one. Null for an empty string: the printer has none.
[[nodiscard]] std::unique_ptr<Relay> open_relay(const std::string& device, Guardian* guardian);

}  // namespace vam::device
