// SPDX-License-Identifier: GPL-3.0-or-later
// SHA-256 (FIPS 180-4), as sha256sum(1) prints it: which bytes a record was made from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace vam {

class Sha256 {
 public:
  void add(const void* bytes, std::size_t size);
  /// 64 hexadecimal digits; nothing may be added after.
  [[nodiscard]] std::string digest();

 private:
  void block(const std::uint8_t* bytes);
  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> pending_{};
  std::size_t filled_ = 0;
  std::uint64_t size_ = 0;
};

[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace vam
