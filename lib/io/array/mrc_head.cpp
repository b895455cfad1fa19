// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/mrc_head.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

namespace vam::io::arrays {

namespace {

constexpr std::size_t header_bytes = 1024;
using Header = std::array<unsigned char, header_bytes>;

/// Word `n` of 4 bytes, counted from 1 as the format's description does.
std::uint32_t word(const Header& header, std::size_t n, bool big_endian) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t shift = 8 * (big_endian ? 3 - i : i);
    value |= std::uint32_t{header[4 * (n - 1) + i]} << shift;
  }
  return value;
}

struct Mode {
  std::uint32_t number;
  char kind;
  int bytes;
};

constexpr Mode modes[] = {{0, 'i', 1}, {1, 'i', 2}, {2, 'f', 4}, {6, 'u', 2}, {12, 'f', 2}};

void set_mode(const Bytes& bytes, std::uint32_t number, Head& head) {
  const auto* mode =
      std::find_if(std::begin(modes), std::end(modes), [&](const Mode& m) { return m.number == number; });
  if (mode == std::end(modes)) {
    bytes.fail("has values of MRC mode " + std::to_string(number) + "; 0, 1, 2, 6 and 12 are read");
  }
  head.kind = mode->kind;
  head.bytes = mode->bytes;
}

}  // namespace

Head take_mrc_head(Bytes& bytes) {
  Header header{};
  bytes.take(header.data(), header.size());
  if (std::string_view(reinterpret_cast<const char*>(header.data()) + mrc_magic_at, mrc_magic.size()) != mrc_magic) {
    bytes.fail("is no MRC volume");
  }
  constexpr std::size_t stamp = 212;
  Head head;
  head.big_endian = header[stamp] == 0x11;
  const auto number = [&](std::size_t n) { return word(header, n, head.big_endian); };
  set_mode(bytes, number(4), head);
  for (std::uint32_t axis = 1; axis <= 3; ++axis) {
    if (number(16 + axis) == axis) continue;
    bytes.fail("has axes in another order than x, y, z (MAPC, MAPR, MAPS); write it again in this order");
  }
  for (std::uint32_t axis = 1; axis <= 3; ++axis) {
    const auto size = static_cast<std::int32_t>(number(axis));
    if (size < 0) bytes.fail("its header is damaged: " + std::to_string(size) + " values along an axis");
  }
  set_shape(bytes, {number(3), number(2), number(1)}, head);
  constexpr std::uint32_t most_extended = 1U << 30;
  const std::uint32_t extended = number(24);
  if (extended > most_extended) bytes.fail("its header is damaged: " + std::to_string(extended) + " further bytes");
  bytes.skip(extended);
  return head;
}

}  // namespace vam::io::arrays
