// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays for NumPy: .npy of little-endian floats.
#pragma once

#include <cstddef>
#include <string>

#include "io/array/array_reader.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

/// Writes images one after the other; size.images of them must follow. "-" is stdout. A file appears at commit().
/// Throws Error: no_output, io.
class ArrayWriter {
 public:
  ArrayWriter(const std::string& path, const ArraySize& size);
  /// `count` values, row by row.
  void write(const float* values, std::size_t count);
  void commit();

 private:
  OutputFile file_;
};

}  // namespace vam::io
