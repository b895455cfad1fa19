// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/private/shown.hpp"

namespace vam::device {

std::string shown(const std::string& bytes) {
  static const char* digits = "0123456789abcdef";
  std::string text;
  for (const char c : bytes.substr(0, 40)) {
    const auto value = static_cast<unsigned char>(c);
    if (value >= 32 && value < 127) {
      text += c;
    } else {
      text += std::string("\\x") + digits[value >> 4U] + digits[value & 15U];
    }
  }
  return text + (bytes.size() > 40 ? "..." : "");
}

}  // namespace vam::device
