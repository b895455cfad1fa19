// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: a dataset of an HDF5 file as images, one after the other.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/array/array_reader.hpp"
#include "io/array/private/array_bytes.hpp"
#include "io/array/private/array_head.hpp"

namespace vam::io::arrays {

/// Before the bytes are parsed in a process that can open no file. Throws Fault::absent where libhdf5 is not installed.
void load_hdf5();

struct Hdf5Images {
  Head head;         // of floats: images, rows, columns
  Bytes::Read read;  // the values image by image
};

/// Reads front to back in any order of the axes, as many images at a time as `memory` bytes hold. What libhdf5 unpacks
/// is read (gzip, shuffle, szip), of integers, floats and booleans of any size and byte order, and a Julia BitArray.
/// The bytes must outlive `read`. Throws Error that begins with `name`: data (truncated, damaged, not numbers, values
/// in other files, another number of dimensions), usage (several datasets and none named, none of that name), with the
/// datasets that are there.
[[nodiscard]] Hdf5Images open_hdf5(std::string_view bytes, const ArrayOptions& options, std::uint64_t memory,
                                   const std::string& name);

}  // namespace vam::io::arrays
