// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: the formats, in the process that parses them. They throw std::runtime_error, to stand
// behind the file's name, and Error, which begins with it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/array/private/array.hpp"
#include "io/zip/zip_archive.hpp"

namespace vam::io::arrays {

inline constexpr std::string_view npy_magic = "\x93NUMPY";
inline constexpr std::string_view nrrd_magic = "NRRD000";

/// The header of a NumPy file (numpy.lib.format, versions 1.0 to 3.0). Throws std::runtime_error: not such a file, and
/// as parse_npy_head().
[[nodiscard]] Head take_npy_head(Bytes& bytes);
/// From the header text. Throws std::runtime_error: not numbers (Python objects, text, records, complex), a shape that
/// is not read, no such text.
[[nodiscard]] Head parse_npy_head(std::string_view text);
/// Magic, version 1.0 and header text of little-endian floats in C order, as NumPy pads them.
[[nodiscard]] std::string head_of_floats(const std::array<int, 3>& shape);

/// The bytes of one array of a .npz, a zip archive of .npy, unpacked as they are read. `name` without .npy; empty: the
/// only one. The archive must outlive them; `stated` becomes their number. Throws Error: data (no array), usage
/// (several and no name; no array of that name), with the names that are there; and as ZipArchive does.
[[nodiscard]] Bytes open_array(ZipArchive& archive, const std::string& name, const std::string& file,
                               std::uint64_t& stated);
/// Throws std::runtime_error where fewer bytes were stated than the values take that the header promises; to unpack
/// what is there may take minutes.
void require_values(const Head& head, std::uint64_t stated);

/// The header of an NRRD file as write_nrrd() writes it; the bytes that follow are the values, floats or bytes.
/// voxel_mm: the edge of the cubes along x, y and z that it states; 0: none. Throws std::runtime_error: not such a
/// file, other fields or values.
[[nodiscard]] Head take_nrrd_head(Bytes& bytes, double& voxel_mm);

/// Before the bytes are parsed in a process that can open no file. Throws Fault::absent where libhdf5 is not installed.
void load_hdf5();
/// The values of a dataset as floats. What libhdf5 unpacks is read (gzip, shuffle, szip), of integers, floats and
/// booleans of any size and byte order, and a Julia BitArray. The bytes must outlive what is returned. Throws Error:
/// data (truncated, damaged, not numbers, values in other files, another number of dimensions), usage (several datasets
/// and none named, none of that name), with the datasets that are there.
[[nodiscard]] Bytes open_hdf5(std::string_view bytes, const std::string& wanted, const std::string& name, Head& head);

}  // namespace vam::io::arrays
