// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: which datasets an HDF5 file holds, the one that is meant, and what belongs to it.
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
  std::string holds{};     // "strings", "a link to /a, ...": where these are no numbers
  BitArray bits{};         // words: 0 where it is none
  bool is_signal = false;  // what a NeXus group is there to show
  bool is_lost = false;    // a link to what is not in the file
  haddr_t address = 0;     // one place in the file may have several paths
};

/// Shape and type of an open dataset.
[[nodiscard]] Dataset describe(hid_t dataset, const std::string& path);

/// The one meant: the named one; else /exchange/data; else what the NeXus groups show; else the only one of 3
/// dimensions. Throws Error that begins with `name`: usage (none of that name; several), data (none of 3 dimensions; a
/// link to what is not in the file), with the datasets that are there.
[[nodiscard]] std::string chosen_path(hid_t file, const std::string& named, const std::string& name);

/// What belongs to the projections at a path: in the group of theirs, or at NXtomo's places in the NeXus entry.
struct Convention {
  bool known = false;      // frames [angle][row][column], row 0 at the top
  std::string angles;      // the path of the stage angles; empty: none
  std::string image_keys;  // the path of NXtomo's keys: 0 is a projection, others are flat, dark or invalid
};
[[nodiscard]] Convention convention_of(hid_t file, const std::string& path);

/// The numbers of projections at a path; angles in degrees, or in the radians that its attribute `units` states, in
/// degrees. Throws Fault::data that begins with `name`: other units, no numbers.
[[nodiscard]] std::vector<double> numbers_of(hid_t file, const std::string& path, const std::string& name);

}  // namespace vam::io::arrays
