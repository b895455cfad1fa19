// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/array_head.hpp"

#include <stdexcept>
#include <string>

namespace vam::io::arrays {

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  std::string text;
  for (const std::uint64_t size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text.empty() ? "one number" : text;
}

void set_shape(const std::vector<std::uint64_t>& shape, Head& head) {
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

}  // namespace vam::io::arrays
