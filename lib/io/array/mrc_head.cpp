#include "io/array/private/mrc_head.hpp"

#include <array>
#include <cstdint>
#include <stdexcept>
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

void set_mode(const Bytes& bytes, std::uint32_t mode, Head& head) {
  switch (mode) {
    case 0:
      head.kind = 'i', head.bytes = 1;
      return;
    case 1:
      head.kind = 'i', head.bytes = 2;
      return;
    case 2:
      head.kind = 'f', head.bytes = 4;
      return;
    case 6:
      head.kind = 'u', head.bytes = 2;
      return;
    case 12:
      head.kind = 'f', head.bytes = 2;
      return;
    default:
      bytes.fail("has values of MRC mode " + std::to_string(mode) + "; 0, 1, 2, 6 and 12 are read");
  }
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
  try {
    set_shape({number(3), number(2), number(1)}, head);
  } catch (const std::runtime_error& problem) {
    bytes.fail(problem.what());
  }
  constexpr std::uint32_t most_extended = 1U << 30;
  const std::uint32_t extended = number(24);
  if (extended > most_extended) bytes.fail("its header is damaged: " + std::to_string(extended) + " further bytes");
  bytes.skip(extended);
  return head;
}

}  // namespace vam::io::arrays
