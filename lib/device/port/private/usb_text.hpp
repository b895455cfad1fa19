// SPDX-License-Identifier: GPL-3.0-or-later
// Descriptor strings of a USB device.
#pragma once

#include <string>

struct libusb_device_handle;

namespace vam::device {

/// The string of that number; empty when it has none.
[[nodiscard]] std::string string_of(libusb_device_handle* handle, unsigned char index);

}  // namespace vam::device
