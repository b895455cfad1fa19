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
  /// `read(to, size)` returns fewer only at the end; `name` begins messages.
  using Read = std::function<std::size_t(void*, std::size_t)>;
  Bytes(Read read, std::string name);

  /// Throws Fault::data where fewer are left.
  void take(void* to, std::size_t size);
  /// Up to and without the next line feed, and without a carriage return before it. Throws Fault::data for a line of
  /// more than 64 KiB.
  [[nodiscard]] std::string line();
  [[nodiscard]] bool ended();
  /// Throws Fault::data: the name, then why.
  [[noreturn]] void fail(const std::string& why) const;

 private:
  Read read_;
  std::string name_;
  std::size_t taken_ = 0;
};

/// set_shape() of a head whose values follow. Throws Fault::data.
void set_shape(const Bytes& bytes, const std::vector<std::uint64_t>& shape, Head& head);

}  // namespace vam::io::arrays
