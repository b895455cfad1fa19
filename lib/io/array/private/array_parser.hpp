// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: an array as images, in the process that parses it.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/image.hpp"
#include "io/array/private/array.hpp"

namespace vam::io::arrays {

/// The values front to back.
class Parser {
 public:
  /// Which axis of the array counts images, rows and columns. Throws std::runtime_error.
  Parser(const Head& head, Bytes values, std::array<int, 3> axes);
  /// Images, rows, columns.
  [[nodiscard]] const std::array<std::size_t, 3>& size() const { return size_; }
  /// Image `k`, in ascending order. Throws std::runtime_error: cut off, more bytes than values, a value that is not
  /// finite.
  void next(Image& image);

 private:
  void take_floats(float* to, std::size_t count);
  void hold_all();
  void gather();
  void check(const Image& image) const;
  void require_end();

  Head head_;
  Bytes bytes_;
  std::array<std::size_t, 3> size_{};
  std::array<std::size_t, 3> stride_{};  // in values, from image to image, row to row, column to column
  bool streams_ = false;                 // the images are as they come
  std::vector<char> raw_;
  std::vector<float> all_;  // where they are not
  std::vector<Image> some_;
  std::size_t done_ = 0;  // images
};

}  // namespace vam::io::arrays
