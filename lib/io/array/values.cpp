// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/values.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace vam::io::arrays {

namespace {

std::uint8_t swapped(std::uint8_t word) { return word; }
std::uint16_t swapped(std::uint16_t word) { return __builtin_bswap16(word); }
std::uint32_t swapped(std::uint32_t word) { return __builtin_bswap32(word); }
std::uint64_t swapped(std::uint64_t word) { return __builtin_bswap64(word); }

// IEEE 754 binary16.
float half_to_float(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31;
  const int fraction = bits & 1023;
  const float sign = (bits & 0x8000) != 0 ? -1.0F : 1.0F;
  if (exponent == 31) return std::numeric_limits<float>::quiet_NaN();
  if (exponent == 0) return sign * std::ldexp(static_cast<float>(fraction), -24);
  return sign * std::ldexp(static_cast<float>(1024 + fraction), exponent - 25);
}

template <class Word, class Convert>
void convert(const Head& head, const char* bytes, std::size_t count, float* to, const Convert& number) {
  for (std::size_t i = 0; i < count; ++i) {
    Word word;
    std::memcpy(&word, bytes + i * sizeof word, sizeof word);
    to[i] = number(head.big_endian ? swapped(word) : word);
  }
}

template <class Word, class Signed>
void whole_to_floats(const Head& head, const char* bytes, std::size_t count, float* to) {
  if (head.kind == 'i') {
    convert<Word>(head, bytes, count, to, [](Word word) { return static_cast<float>(static_cast<Signed>(word)); });
  } else {
    convert<Word>(head, bytes, count, to, [](Word word) { return static_cast<float>(word); });
  }
}

float narrowed(std::uint64_t word) {
  const auto value = std::bit_cast<double>(word);
  if (!(std::abs(value) <= std::numeric_limits<float>::max())) return std::numeric_limits<float>::infinity();
  return static_cast<float>(value);
}

void real_to_floats(const Head& head, const char* bytes, std::size_t count, float* to) {
  if (head.bytes == 2) return convert<std::uint16_t>(head, bytes, count, to, half_to_float);
  if (head.bytes == 8) return convert<std::uint64_t>(head, bytes, count, to, narrowed);
  if (!head.big_endian) {
    std::memcpy(to, bytes, count * sizeof *to);
    return;
  }
  convert<std::uint32_t>(head, bytes, count, to, [](std::uint32_t word) { return std::bit_cast<float>(word); });
}

}  // namespace

void to_floats(const Head& head, const char* bytes, std::size_t count, float* to) {
  if (head.kind == 'f') return real_to_floats(head, bytes, count, to);
  if (head.kind == 'b')  // any byte but 0 is true, as in NumPy
    return convert<std::uint8_t>(head, bytes, count, to, [](std::uint8_t byte) { return byte != 0 ? 1.0F : 0.0F; });
  if (head.bytes == 1) return whole_to_floats<std::uint8_t, std::int8_t>(head, bytes, count, to);
  if (head.bytes == 2) return whole_to_floats<std::uint16_t, std::int16_t>(head, bytes, count, to);
  if (head.bytes == 4) return whole_to_floats<std::uint32_t, std::int32_t>(head, bytes, count, to);
  whole_to_floats<std::uint64_t, std::int64_t>(head, bytes, count, to);
}

}  // namespace vam::io::arrays
