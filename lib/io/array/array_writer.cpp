// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/array_writer.hpp"

#include <bit>

#include "io/array/private/npy_head.hpp"

namespace vam::io {

static_assert(std::endian::native == std::endian::little, "the header states little-endian");

ArrayWriter::ArrayWriter(const std::string& path, const ArraySize& size) : file_(path) {
  file_.require_space(1.0 * sizeof(float) * size.images * size.rows * size.columns);
  file_.write(arrays::head_of_floats({size.images, size.rows, size.columns}));
}

void ArrayWriter::write(const float* values, std::size_t count) { file_.write(values, count * sizeof *values); }

void ArrayWriter::commit() { file_.commit(); }

}  // namespace vam::io
