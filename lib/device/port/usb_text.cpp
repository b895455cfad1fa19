// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/port/private/usb_text.hpp"

#include <libusb.h>

#include <array>

namespace vam::device {

std::string string_of(libusb_device_handle* handle, unsigned char index) {
  std::array<unsigned char, 256> text{};
  if (index == 0 || libusb_get_string_descriptor_ascii(handle, index, text.data(), text.size()) <= 0) return "";
  return reinterpret_cast<const char*>(text.data());
}

}  // namespace vam::device
