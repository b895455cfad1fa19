// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/methods/archive.hpp"

#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.hpp"

namespace vam::optimize {

void Archive::move(void* bytes, std::size_t size) {
  move_(bytes, size);
  const auto* from = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < size; i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, from + i, std::min(sizeof word, size - i));
    sum_ = std::rotl((sum_ ^ word) * 0x9FB21C651E98DF25U, 29);  // as digest() in schedule.cpp
  }
}

void Archive::seal() {
  const std::uint64_t sum = sum_;
  std::uint64_t given = sum;
  move(&given, sizeof given);
  if (given != sum) throw Error{Fault::data, name_ + ": damaged (its checksum is wrong); start again without it"};
}

void Archive::end() const {
  if (!at_end_ || at_end_()) return;
  throw Error{Fault::data, name_ + ": damaged (something follows its end); start again without it"};
}

std::size_t Archive::count(std::size_t size) {
  constexpr std::uint64_t most = std::uint64_t{1} << 31U;
  std::uint64_t n = size;
  (*this)(n);
  if (n > most) throw Error{Fault::data, name_ + ": damaged (a list of " + std::to_string(n) + " values); start again"};
  return static_cast<std::size_t>(n);
}

void Archive::numbers(float* values, std::size_t size) {
  move(values, size * sizeof(float));
  if (!reading() || std::all_of(values, values + size, [](float v) { return std::isfinite(v); })) return;
  throw Error{Fault::data, name_ + ": holds values that are not finite numbers (NaN); start again without it"};
}

void Archive::operator()(double& value) {
  move(&value, sizeof value);
  if (reading() && !std::isfinite(value)) {
    throw Error{Fault::data, name_ + ": holds values that are not finite numbers (NaN); start again without it"};
  }
}

void Archive::operator()(Slab& slab) {
  constexpr int most = 1 << 17;
  (*this)(slab.width);
  (*this)(slab.height);
  if (slab.width < 0 || slab.height < 0 || slab.width > most || slab.height > most) {
    throw Error{Fault::data, name_ + ": damaged (a slice of " + std::to_string(slab.width) + " x " +
                                 std::to_string(slab.height) + "); start again"};
  }
  if (reading()) slab = Slab(slab.width, slab.height);
  numbers(slab.values.data(), slab.values.size());
}

void Archive::operator()(std::string& text) {
  text.resize(count(text.size()));
  move(text.data(), text.size());
}

}  // namespace vam::optimize
