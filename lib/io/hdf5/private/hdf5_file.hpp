// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the HDF5 files: opens one whose bytes are at hand, as the process that parses it may open none.
#pragma once

#include <string>

#include "io/hdf5/hdf5_array.hpp"
#include "io/hdf5/private/hdf5_handle.hpp"

namespace vam::io::hdf5 {

/// For reading; no plugins, nothing said on stderr. `bytes` must outlive it. Throws Fault::data, beginning with
/// `name`: truncated, damaged, not closed by its writer, or followed by other bytes.
[[nodiscard]] Handle open_file(const Hdf5Bytes& bytes, const std::string& name);

}  // namespace vam::io::hdf5
