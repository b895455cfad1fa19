// What a USB device says of itself.
#pragma once

#include <libusb.h>

#include <array>
#include <string>

namespace vam::device {

/// The string of that number; empty when it has none.
inline std::string string_of(libusb_device_handle* handle, unsigned char index) {
  std::array<unsigned char, 256> text{};
  if (index == 0 || libusb_get_string_descriptor_ascii(handle, index, text.data(), text.size()) <= 0) return "";
  return reinterpret_cast<const char*>(text.data());
}

}  // namespace vam::device
