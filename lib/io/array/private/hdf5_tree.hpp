// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: which datasets an HDF5 file holds and the one that is meant.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/array/private/hdf5_library.hpp"

namespace vam::io::arrays {

/// A Julia BitArray of 3 dimensions as JLD2 stores it: one record, its words in a dataset of their own. Bit i, from the
/// lowest, of word w is value 64 w + i; the first dimension is the fastest.
struct BitArray {
  hobj_ref_t words = 0;
  std::int64_t length = 0;
  std::array<std::int64_t, 3> sizes{};  // the fastest first
};

struct Dataset {
  std::string path;
  std::vector<std::uint64_t> shape{};
  std::string holds{};   // "strings", "a link to /a, ...": where these are no numbers
  BitArray bits{};       // words: 0 where it is none
  bool is_lost = false;  // a link to what is not in the file
  haddr_t address = 0;   // one place in the file may have several paths
};

/// Shape and type of an open dataset.
[[nodiscard]] Dataset describe(hid_t dataset, const std::string& path);

/// The one meant: the named one; else the only one of 3 dimensions. Throws Error that begins with `name`: usage (none
/// of that name; several), data (none of 3 dimensions; a link to what is not in the file), with the datasets that are
/// there.
[[nodiscard]] std::string chosen_path(hid_t file, const std::string& named, const std::string& name);

}  // namespace vam::io::arrays
