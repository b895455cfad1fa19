// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the HDF5 files: which datasets one holds, and the one that is meant.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/hdf5/private/hdf5_handle.hpp"

namespace vam::io::hdf5 {

struct Dataset {
  std::string path;
  std::vector<std::uint64_t> shape;
  std::string holds;          // "strings", "a link to /a, ...": where these are no numbers
  bool is_signal = false;     // what a NeXus group is there to show
  std::uint64_t address = 0;  // one place in the file may have several paths
  bool is_lost = false;       // a link to what is not in the file
};

/// In the order of their names, at most 4096 links; those that lead nowhere, or to other files, are lost ones.
[[nodiscard]] std::vector<Dataset> datasets_of(hid_t file);

/// Path, shape and type of an open one.
[[nodiscard]] Dataset describe(hid_t dataset, const std::string& path);

/// The path of the one meant: the named one; else /exchange/data; else what the NeXus groups show; else the only one of
/// 3 dimensions. Throws Error that begins with `name`: usage (none of that name; several), data (none of 3 dimensions;
/// a link to what is not in the file), with the datasets that are there.
[[nodiscard]] std::string chosen_path(hid_t file, const std::string& named, const std::string& name);

}  // namespace vam::io::hdf5
