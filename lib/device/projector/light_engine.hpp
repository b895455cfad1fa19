// SPDX-License-Identifier: GPL-3.0-or-later
// The light engine of a projector: LEDs, their current, and whether grey is linear [devices §5].
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/text/json_fwd.hpp"
#include "device/os/clock.hpp"
#include "device/os/lock.hpp"
#include "device/port/usb_link.hpp"
#include "device/projector/lamp.hpp"
#include "device/safety/guardian.hpp"

namespace vam::device {

struct LightSettings {
  std::optional<double> current_percent;  // of full current, 0..100; absent: as it is
  double max_current_percent = 40;        // a larger current is refused
  std::string leds = "b";                 // any of r, g, b
};

/// A DLP controller on USB. Between on() and dark() the guardian holds the order to darken. Throws Error: absent, busy
/// (no answer), protocol (NACK, wrong answer, or a setting that does not read back), usage (current above the limit).
class LightEngine : public Lamp {
 public:
  /// Model, firmware, status bits.
  virtual Json identify() = 0;
  /// Awake, video input, linear grey (DLPC350: gamma off; DLPC900: video pattern mode, which needs an image at its
  /// input) and current set, each read back. LEDs stay off. The bytes of a current mean what board and polarity make
  /// of them: on a LightCrafter 4500 255 is none and 0 full current.
  virtual void prepare() = 0;
  /// LEDs off, read back. Never by the current: whether 0 or 255 is dark differs between boards.
  void dark() override = 0;
  /// dark(), then no pattern, then asleep: what the destructor of an engine does that was prepared.
  virtual void standby() = 0;

  void hold(std::unique_ptr<DeviceLock> lock) { lock_ = std::move(lock); }

 private:
  std::unique_ptr<DeviceLock> lock_;
};

/// Which of the two controllers it is follows from the link's usb_id.
[[nodiscard]] std::unique_ptr<LightEngine> make_dlp_light(std::unique_ptr<UsbLink> link, const LightSettings& settings,
                                                          Clock& clock, Guardian* guardian);

}  // namespace vam::device
