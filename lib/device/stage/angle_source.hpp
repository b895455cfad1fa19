// SPDX-License-Identifier: GPL-3.0-or-later
// Where the player learns the angle of the stage from.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "device/os/angle_sample.hpp"
#include "device/os/clock.hpp"

namespace vam::device {

class AngleSource {
 public:
  virtual ~AngleSource() = default;
  /// Takes in what has become known. Throws when the stage can no longer be followed.
  virtual void update() = 0;
  /// The angle at a moment of the near future; nothing before it is known.
  [[nodiscard]] virtual std::optional<AngleSample> at(double t_s) const = 0;
};

/// By the clock alone, as the printer with tomography during the print: the angle is speed times the time since the
/// first question [OST22].
[[nodiscard]] std::unique_ptr<AngleSource> elapsed_angle(double speed_deg_s, Clock& clock);

/// Of a stage that stands.
[[nodiscard]] std::unique_ptr<AngleSource> standing_angle(double angle_deg);

/// By the lines of vam-stage from a file, FIFO, or "-" (stdin): their running line fit, extrapolated. update() throws
/// Fault::data for a bad line, Fault::busy when nothing came for 0.5 s or the lines have ended, unless they have
/// reached last_deg: after the last turn vam-stage writes nothing while it brakes, and who is late still needs the
/// angles before. Before the first line it waits without limit. Throws Fault::no_input when the file cannot be opened.
[[nodiscard]] std::unique_ptr<AngleSource> followed_angle(const std::string& path, Clock& clock, double last_deg);

}  // namespace vam::device
