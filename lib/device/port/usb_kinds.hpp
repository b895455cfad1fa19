// SPDX-License-Identifier: GPL-3.0-or-later
// USB devices that these tools drive: the one table of the ids by which they are opened, found and distinguished.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "device/port/usb_link.hpp"

struct libusb_device_handle;

namespace vam::device {

struct UsbKind {
  std::string_view scheme;  // of its device string
  const char* kind;         // stage or light
  int vendor;
  std::array<int, 6> products;  // 0: no more
  const char* options;          // that its device string needs
};

inline constexpr std::array usb_kinds{
    UsbKind{"tic", "stage", 0x1ffb, {0x00b3, 0x00b5, 0x00bd, 0x00c3, 0x00c9, 0x00cb}, "?steps_per_deg=N"},
    UsbKind{"dlpc350", "light", 0x0451, {0x6401}, ""}, UsbKind{"dlpc900", "light", 0x0451, {0xc900}, ""}};

/// The kind of that scheme, which is in the table.
[[nodiscard]] constexpr const UsbKind& usb_kind(std::string_view scheme) {
  return *std::find_if(usb_kinds.begin(), usb_kinds.end(), [&](const UsbKind& kind) { return kind.scheme == scheme; });
}

/// The kind with these ids; null when there is none.
[[nodiscard]] constexpr const UsbKind* usb_kind(int vendor, int product) {
  const auto* found = std::find_if(usb_kinds.begin(), usb_kinds.end(), [&](const UsbKind& kind) {
    return kind.vendor == vendor &&
           std::find(kind.products.begin(), kind.products.end(), product) != kind.products.end();
  });
  return found != usb_kinds.end() ? found : nullptr;
}

/// What open_usb needs for a device of that scheme; an empty serial number is the only one there is.
[[nodiscard]] UsbId usb_id(std::string_view scheme, const std::string& serial);

/// "0451:c900"
[[nodiscard]] std::string ids_text(int vendor, int product);

/// The descriptor string of that number; empty when the device has none.
[[nodiscard]] std::string string_of(libusb_device_handle* handle, unsigned char index);

}  // namespace vam::device
