// SPDX-License-Identifier: GPL-3.0-or-later
// The command protocol of TI's DLPC350 (LightCrafter 4500) and DLPC900 (6500, 9000) in USB HID reports.
// Source: TI DLPU010 and DLPU018, "Programmer's Guide".
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "device/os/clock.hpp"
#include "device/port/usb_link.hpp"
#include "device/safety/guardian.hpp"

namespace vam::device {

/// CMD2 and CMD3.
enum class DlpCommand : unsigned {
  power = 0x0200,
  firmware = 0x0205,
  led_current = 0x0B01,
  input_source = 0x1A00,
  video_receiver = 0x1A01,  // DLPC900
  led_polarity = 0x1A05,
  led_enable = 0x1A07,
  hardware_status = 0x1A0A,
  system_status = 0x1A0B,
  main_status = 0x1A0C,
  gamma = 0x1A0E,  // DLPC350
  display_mode = 0x1A1B,
  pattern_start_stop = 0x1A24,
  pattern_table = 0x1A31,  // DLPC900
  pattern = 0x1A34,        // DLPC900
};

using DlpBytes = std::vector<int>;  // each 0..255

/// flags, sequence, length (little endian, of command and data), CMD3, CMD2, data; at most 58 bytes of data.
[[nodiscard]] std::string dlp_report(int flags, int sequence, DlpCommand command, const DlpBytes& data);

/// Asks and tells. Throws Error: absent, busy (no answer), protocol (NACK, wrong answer, or a setting that does not
/// read back). Every answer is a heartbeat to the guardian, when there is one.
class DlpLink {
 public:
  DlpLink(std::unique_ptr<UsbLink> usb, Clock& clock, Guardian* guardian)
      : usb_(std::move(usb)), clock_(clock), guardian_(guardian) {}

  [[nodiscard]] const std::string& name() const { return usb_->name(); }
  [[nodiscard]] Json about() const { return usb_->about(); }

  void tell(DlpCommand command, const DlpBytes& data) { (void)exchange(0x40, command, data); }
  [[nodiscard]] DlpBytes ask(DlpCommand command, std::size_t bytes);
  [[nodiscard]] int ask(DlpCommand command) { return ask(command, 1).front(); }
  /// Writes a setting and reads it back: the current in force must be the requested one. patience_s: until it has taken
  /// effect.
  void set(DlpCommand command, const DlpBytes& data, const std::string& what, double patience_s = 0);
  /// False when it is not done in time.
  [[nodiscard]] bool within(double patience_s, const std::function<bool()>& done);

 private:
  DlpBytes exchange(int flags, DlpCommand command, const DlpBytes& data);
  [[nodiscard]] Error wrong(DlpCommand command, const std::string& what) const;

  std::unique_ptr<UsbLink> usb_;
  Clock& clock_;
  Guardian* guardian_;
  int sequence_ = 0;
};

}  // namespace vam::device
