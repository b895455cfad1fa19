// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the HDF5 files: the conventions by which projections are kept, DXchange and NXtomo [formats: Arrays].
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/hdf5/private/hdf5_handle.hpp"

namespace vam::io::hdf5 {

/// What belongs to the projections at a path: in the group of theirs, or at NXtomo's places in the NeXus entry.
struct Convention {
  bool known = false;      // frames [angle][row][column], row 0 at the top
  std::string angles;      // the path of the stage angles; empty: none
  std::string image_keys;  // the path of NXtomo's keys: 0 is a projection, others are flat, dark or invalid
};
[[nodiscard]] Convention convention_of(hid_t file, const std::string& path);

/// Degrees, or radians where the attribute `units` says so, in degrees. Throws Fault::data that begins with `name`:
/// other units, no numbers.
[[nodiscard]] std::vector<double> angles_deg(hid_t file, const std::string& path, const std::string& name);

/// Which of `frames` are projections. Throws Fault::data that begins with `name`: none, another number of keys.
[[nodiscard]] std::vector<std::size_t> projections(hid_t file, const std::string& path, std::size_t frames,
                                                   const std::string& name);

}  // namespace vam::io::hdf5
