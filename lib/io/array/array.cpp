// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/array.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/error.hpp"
#include "io/stream/finite.hpp"

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

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  std::string text;
  for (const std::uint64_t size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text.empty() ? "one number" : text;
}

void set_shape(std::vector<std::uint64_t> shape, Head& head) {
  while (shape.size() > 3 && shape.back() == 1) shape.pop_back();
  if (shape.size() != 2 && shape.size() != 3) {
    throw std::runtime_error("has " + std::to_string(shape.size()) + " axes" +
                             (shape.empty() ? "" : " (" + shape_text(shape) + ")") + "; arrays of 2 or 3 are read");
  }
  head.shape = {1, shape[shape.size() - 2], shape.back()};
  if (shape.size() == 3) head.shape[0] = shape[0];
  for (const std::uint64_t size : shape) {
    if (size == 0) throw std::runtime_error("is an empty array (" + shape_text(shape) + ")");
    if (size > most_side) {
      throw std::runtime_error("has " + shape_text(shape) + " values; up to 65536 along an axis are read");
    }
  }
  if (head.values() > most_values) {
    throw std::runtime_error("has " + shape_text(shape) + " values; up to 2^40 are read");
  }
}

void to_floats(const Head& head, const char* bytes, std::size_t count, float* to) {
  if (head.kind == 'f') return real_to_floats(head, bytes, count, to);
  if (head.kind == 'b')  // any byte but 0 is true, as in NumPy
    return convert<std::uint8_t>(head, bytes, count, to, [](std::uint8_t byte) { return byte != 0 ? 1.0F : 0.0F; });
  if (head.bytes == 1) return whole_to_floats<std::uint8_t, std::int8_t>(head, bytes, count, to);
  if (head.bytes == 2) return whole_to_floats<std::uint16_t, std::int16_t>(head, bytes, count, to);
  if (head.bytes == 4) return whole_to_floats<std::uint32_t, std::int32_t>(head, bytes, count, to);
  whole_to_floats<std::uint64_t, std::int64_t>(head, bytes, count, to);
}

void Bytes::take(void* to, std::size_t size) {
  const std::size_t got = read_(to, size);
  taken_ += got;
  if (got == size) return;
  throw std::runtime_error("is cut off after " + std::to_string(taken_) +
                           " bytes; the program that wrote it did not finish");
}

std::string Bytes::line() {
  constexpr std::size_t most_line = 1 << 16;
  std::string text;
  for (char next = 0;;) {
    take(&next, 1);
    if (next == '\n') break;
    text += next;
    if (text.size() > most_line) {
      throw std::runtime_error("its header is damaged: a line has more than 65536 characters");
    }
  }
  if (text.ends_with('\r')) text.pop_back();
  return text;
}

bool Bytes::ended() {
  char more = 0;
  return read_(&more, 1) == 0;
}

namespace {

constexpr std::size_t values_a_pass = 1 << 16;  // values converted at a time
constexpr std::size_t side_by_side = 16;        // images gathered at a time, as their values share cache lines

// Of the array's own axes, in values.
std::array<std::size_t, 3> strides(const Head& head) {
  if (head.fortran) return {1, head.shape[0], head.shape[0] * head.shape[1]};
  return {head.shape[1] * head.shape[2], head.shape[2], 1};
}

}  // namespace

Parser::Parser(const Head& head, Bytes values, std::array<int, 3> axes, std::array<bool, 3> reversed)
    : head_(head), bytes_(std::move(values)), reversed_(reversed) {
  const std::array<std::size_t, 3> own = strides(head_);
  for (std::size_t i = 0; i < 3; ++i) {
    size_[i] = head_.shape[axes[i]];
    stride_[i] = own[axes[i]];
  }
  if (size_[1] * size_[2] > most_image) throw std::runtime_error("has images of more than 2^28 values");
  streams_ = !reversed_[0] && stride_[2] == 1 && stride_[1] == size_[2] &&
             (stride_[0] == size_[1] * size_[2] || size_[0] == 1);
}

void Parser::take_floats(float* to, std::size_t count) {
  const auto bytes = static_cast<std::size_t>(head_.bytes);
  raw_.resize(values_a_pass * bytes);
  for (std::size_t done = 0; done < count; done += values_a_pass) {
    const std::size_t step = std::min(values_a_pass, count - done);
    bytes_.take(raw_.data(), step * bytes);
    to_floats(head_, raw_.data(), step, to + done);
  }
}

void Parser::hold_all() {
  all_.resize(head_.values());
  take_floats(all_.data(), all_.size());
  require_end();
}

void Parser::gather() {
  const std::size_t count = std::min(side_by_side, size_[0] - done_);
  some_.assign(count, Image(static_cast<int>(size_[2]), static_cast<int>(size_[1])));
  for (std::size_t r = 0; r < size_[1]; ++r) {
    for (std::size_t c = 0; c < size_[2]; ++c) {
      const float* from = all_.data() + r * stride_[1] + c * stride_[2];
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t image = reversed_[0] ? size_[0] - 1 - done_ - k : done_ + k;
        some_[k].values[r * size_[2] + c] = from[image * stride_[0]];
      }
    }
  }
}

void Parser::check(const Image& image) const {
  if (all_finite(image.values.data(), image.size())) return;
  const auto bad = std::find_if(image.values.begin(), image.values.end(), [](float v) { return !std::isfinite(v); });
  const auto at = bad - image.values.begin();
  throw std::runtime_error("column " + std::to_string(at % image.width) + ", row " + std::to_string(at / image.width) +
                           " of image " + std::to_string(done_) +
                           " is not a finite number; replace such values, and save the array again");
}

void Parser::require_end() {
  if (bytes_.ended()) return;
  throw std::runtime_error("has bytes behind its " + std::to_string(head_.values()) +
                           " values; it is damaged, or several arrays in one");
}

void Parser::next(Image& image) {
  if (streams_) {
    image = Image(static_cast<int>(size_[2]), static_cast<int>(size_[1]));
    take_floats(image.values.data(), image.size());
    if (done_ + 1 == size_[0]) require_end();
  } else {
    if (done_ == 0) hold_all();
    if (done_ % side_by_side == 0) gather();
    image = std::move(some_[done_ % side_by_side]);
  }
  check(image);
  for (int r = 0; r < image.height && reversed_[2]; ++r) std::reverse(image.row(r), image.row(r) + image.width);
  for (int r = 0; r < image.height / 2 && reversed_[1]; ++r)
    std::swap_ranges(image.row(r), image.row(r) + image.width, image.row(image.height - 1 - r));
  ++done_;
}

}  // namespace vam::io::arrays
