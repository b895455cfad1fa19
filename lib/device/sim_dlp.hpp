// A simulated DLPC350, with what may be wrong with one.
#pragma once

#include <memory>

#include "device/sim_options.hpp"
#include "device/usb_link.hpp"

namespace vam::device {

struct SimDlpSettings {
  int current = 40;
  bool stuck_gamma = false;    // keeps its gamma on, whatever it is told
  int refuse = 0;              // command (CMD2 << 8 | CMD3) that gets a NACK
  int silent_after = 1 << 30;  // reports, then no more answers
  int garble_after = 1 << 30;  // reports, then answers of noise
};

/// Its log has a line for every change of what shines: {"event": "leds", "bits": 4}.
[[nodiscard]] std::unique_ptr<UsbLink> make_sim_dlp(const SimDlpSettings& settings, SimLog log);

}  // namespace vam::device
