// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/array_head.hpp"

#include <stdexcept>
#include <string>

#include "io/hdf5/hdf5_array.hpp"

namespace vam::io::arrays {

void set_shape(const std::vector<std::uint64_t>& shape, Head& head) {
  if (shape.size() != 2 && shape.size() != 3) {
    throw std::runtime_error("has " + std::to_string(shape.size()) + " axes" +
                             (shape.empty() ? "" : " (" + hdf5::shape_text(shape) + ")") +
                             "; arrays of 2 or 3 are read");
  }
  head.shape = {1, shape[shape.size() - 2], shape.back()};
  if (shape.size() == 3) head.shape[0] = shape[0];
  for (const std::uint64_t size : shape) {
    if (size == 0) throw std::runtime_error("is an empty array (" + hdf5::shape_text(shape) + ")");
    if (size > most_side) {
      throw std::runtime_error("has " + hdf5::shape_text(shape) + " values; up to 65536 along an axis are read");
    }
  }
  if (head.values() > most_values) {
    throw std::runtime_error("has " + hdf5::shape_text(shape) + " values; up to 2^40 are read");
  }
}

}  // namespace vam::io::arrays
