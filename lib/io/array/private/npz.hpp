// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: the arrays of a .npz, which is a zip archive of .npy.
#pragma once

#include <string>

#include "io/array/private/array_bytes.hpp"
#include "io/zip/zip_archive.hpp"

namespace vam::io::arrays {

/// The bytes of one array, unpacked as they are read. `name` without .npy; empty: the only one. The archive must
/// outlive them; `stated` becomes their number. Throws Error that begins with `file`: data (no array), usage (several
/// and no name; no array of that name), with the names that are there; and as ZipArchive does.
[[nodiscard]] Bytes open_array(ZipArchive& archive, const std::string& name, const std::string& file,
                               std::uint64_t& stated);

/// Throws std::runtime_error where fewer bytes were stated than the values take that the header promises; to unpack
/// what is there may take minutes.
void require_values(const Head& head, std::uint64_t stated);

}  // namespace vam::io::arrays
