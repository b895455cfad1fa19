// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/fingerprint.hpp"

#include <array>
#include <cstdint>
#include <cstdio>

namespace vam {

std::string fingerprint(const GreyImage& levels) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto add = [&hash](unsigned byte) { hash = (hash ^ byte) * 0x100000001b3ULL; };
  for (const std::uint16_t level : levels.values) {
    add(level & 255U);
    if (levels.bits > 8) add(level >> 8U);
  }
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
  return text.data();
}

}  // namespace vam
