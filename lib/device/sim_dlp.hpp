// A simulated DLPC350 or DLPC900, with what may be wrong with one.
#pragma once

#include <memory>
#include <string>

#include "device/sim_options.hpp"
#include "device/usb_link.hpp"

namespace vam::device {

struct SimDlpSettings {
  bool dlpc900 = false;
  int wake_reads = 0;  // so often it says that it still sleeps
  int current = 40;
  bool stuck_gamma = false;  // keeps its gamma on, whatever it is told
  int refuse = 0;            // command (CMD2 << 8 | CMD3) that gets a NACK
  // What spoils every answer from the n-th report (from 0) on: silent · late (the answer comes with the next question)
  // · garbage · truncated (three bytes) · wrong-sender (an answer to another question) · error (NACK) · unplug.
  std::string fault{};
  int fault_after = 0;
};

/// Its log has a line for every change of what shines: {"event": "leds", "bits": 4}.
[[nodiscard]] std::unique_ptr<UsbLink> make_sim_dlp(const SimDlpSettings& settings, SimLog log);

}  // namespace vam::device
