// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: the bytes of an array, front to back, in the process that parses it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/array/private/array_head.hpp"

namespace vam::io::arrays {

class Bytes {
 public:
  /// `read(to, size)` returns fewer only at the end.
  using Read = std::function<std::size_t(void*, std::size_t)>;
  explicit Bytes(Read read) : read_(std::move(read)) {}

  /// Throws std::runtime_error, to stand behind the file's name, where fewer are left.
  void take(void* to, std::size_t size);
  /// Up to and without the next line feed, and without a carriage return before it. Throws as take() for a line of
  /// more than 64 KiB.
  [[nodiscard]] std::string line();
  [[nodiscard]] bool ended();

 private:
  Read read_;
  std::size_t taken_ = 0;
};

}  // namespace vam::io::arrays
