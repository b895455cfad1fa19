// SPDX-License-Identifier: GPL-3.0-or-later
// Serialisation of the optimiser's state: one list of fields for writing and reading.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/compute/slab.hpp"

namespace vam::optimize {

/// archive(a); archive(b); ... writes a and b, or reads them in the same order. Bytes are those of this machine.
/// Reading throws Fault::data for numbers that are not finite and sizes beyond all reason, so that a damaged file is
/// noticed.
class Archive {
 public:
  enum class Direction { out, in };
  using Move = std::function<void(void* bytes, std::size_t size)>;  // takes bytes away, or fills them

  using AtEnd = std::function<bool()>;

  /// `name` is what errors call it; at_end tells a reader whether all has been taken.
  Archive(Direction way, std::string name, Move move, AtEnd at_end = {})
      : way_(way), name_(std::move(name)), move_(std::move(move)), at_end_(std::move(at_end)) {}

  [[nodiscard]] bool reading() const { return way_ == Direction::in; }
  [[nodiscard]] const std::string& name() const { return name_; }

  void operator()(float& value) { numbers(&value, 1); }
  void operator()(double& value);
  void operator()(int& value) { move(&value, sizeof value); }
  void operator()(std::int64_t& value) { move(&value, sizeof value); }
  void operator()(std::uint64_t& value) { move(&value, sizeof value); }
  template <class T>
  requires std::is_enum_v<T>
  void operator()(T& value) { move(&value, sizeof value); }
  void operator()(Slab& slab);
  void operator()(std::string& text);
  /// A checksum of everything up to here, written or compared.
  void seal();
  /// Throws Fault::data if a reader has not reached the end.
  void end() const;

  template <class T, std::size_t N>
  void operator()(std::array<T, N>& values) {
    for (T& value : values) (*this)(value);
  }
  template <class T>
  void operator()(std::vector<T>& values) {
    list(values, [this](T& value) { (*this)(value); });
  }
  /// each(element) moves one. Memory is taken as elements arrive: a damaged size ends with the file.
  template <class T, class Each>
  void list(std::vector<T>& values, const Each& each) {
    const std::size_t size = count(values.size());
    values.resize(std::min(size, values.size()));
    for (std::size_t i = 0; i < size; ++i) {
      if (i == values.size()) values.emplace_back();
      each(values[i]);
    }
  }
  void operator()(std::vector<float>& values) {
    constexpr std::size_t at_once = std::size_t{1} << 20U;
    const std::size_t size = count(values.size());
    for (std::size_t first = 0; first < size; first += at_once) {
      const std::size_t last = std::min(size, first + at_once);
      if (reading()) values.resize(last);
      numbers(values.data() + first, last - first);
    }
    values.resize(size);
  }

 private:
  void move(void* bytes, std::size_t size);
  std::size_t count(std::size_t size);
  void numbers(float* values, std::size_t size);
  Direction way_;
  std::string name_;
  Move move_;
  AtEnd at_end_;
  std::uint64_t sum_ = 0;
};

}  // namespace vam::optimize
