// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/port/usb_kinds.hpp"

#include <libusb.h>

#include <cstdio>
#include <iterator>

namespace vam::device {

UsbId usb_id(std::string_view scheme, const std::string& serial) {
  const UsbKind& kind = usb_kind(scheme);
  UsbId id{kind.vendor, {}, serial};
  std::copy_if(kind.products.begin(), kind.products.end(), std::back_inserter(id.products),
               [](int product) { return product != 0; });
  return id;
}

std::string ids_text(int vendor, int product) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%04x:%04x", static_cast<unsigned>(vendor), static_cast<unsigned>(product));
  return text.data();
}

std::string string_of(libusb_device_handle* handle, unsigned char index) {
  std::array<unsigned char, 256> text{};
  if (index == 0 || libusb_get_string_descriptor_ascii(handle, index, text.data(), text.size()) <= 0) return "";
  return reinterpret_cast<const char*>(text.data());
}

}  // namespace vam::device
