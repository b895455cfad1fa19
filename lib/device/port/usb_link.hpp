// SPDX-License-Identifier: GPL-3.0-or-later
// USB devices by libusb: vendor control transfers and 64-byte reports, each with a time-out.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"

namespace vam::device {

struct UsbId {
  int vendor = 0;
  std::vector<int> products;
  std::string serial;  // empty: the only one there is
};

/// What the backends need of a device; a simulator may stand in for it. Throws Error: absent (gone), busy (no answer in
/// time), protocol (refused the request).
class UsbLink {
 public:
  virtual ~UsbLink() = default;
  /// Vendor request to the device, without or with data from it.
  virtual void control_out(int request, int value, int index) = 0;
  virtual std::string control_in(int request, int value, int index, int length) = 0;
  /// One HID report of 64 bytes to, and one from, the device.
  virtual void write_report(const std::string& report) = 0;
  virtual std::string read_report() = 0;
  /// "usb:1ffb:00b3:00312345", for messages and locks.
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// usb_id, serial, maker, model and firmware.
  [[nodiscard]] virtual Json about() const = 0;
};

/// Opens it; interface >= 0 is taken over from the kernel's HID driver, after `named` was called with the link's name.
/// Throws Fault::absent (none, or no permission), Fault::usage (several, and no serial number to choose by).
[[nodiscard]] std::unique_ptr<UsbLink> open_usb(const UsbId& id, int interface,
                                                const std::function<void(const std::string& name)>& named = {});

}  // namespace vam::device
