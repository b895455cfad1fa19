// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated DLPC350 or DLPC900, with what may be wrong with one.
#pragma once

#include <memory>
#include <string>

#include "device/port/usb_link.hpp"
#include "sim/controllers/controllers.hpp"

namespace vam::sim {

struct SimDlpSettings {
  bool dlpc900 = false;
  int slow_reads = 0;           // number of answers that it still sleeps, has no image yet, is in its old mode
  double current_percent = 16;  // of full current, through each LED
  bool inverted = false;        // LED polarity, as found
  bool stuck_polarity = false;  // keeps it, whatever the command
  bool stuck_grey = false;      // keeps its gamma on (DLPC350), its video mode (DLPC900), whatever the command
  bool no_signal = false;       // at its input
  int refuse = 0;               // command (CMD2 << 8 | CMD3) that is answered by a NACK
  // What spoils every answer from the n-th report (from 0) on: silent · late (the answer comes with the next question)
  // · garbage · truncated (three bytes) · wrong-sender (an answer to another question) · error (NACK) · unplug.
  std::string fault{};
  int fault_after = 0;
};

/// Its log has a line for every change of what shines: {"event": "leds", "bits": 4, "linear": true, "current_percent":
/// [16, 16, 16]}, the true current by which its LEDs would shine, and {"event": "asleep"}. A DLPC350 is that of a
/// LightCrafter 4500, whose LED drivers invert what it puts out (TI forum, thread 451589: at normal polarity FF is
/// off).
[[nodiscard]] std::unique_ptr<device::UsbLink> make_sim_dlp(const SimDlpSettings& settings, SimLog log);

}  // namespace vam::sim
