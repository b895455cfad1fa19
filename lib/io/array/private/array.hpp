// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: the formats, in the process that parses them, and what every one comes down to: the type
// of the numbers, how they lie, their bytes front to back, and the images that they are. Throws std::runtime_error, to
// stand behind the file's name, and Error, which begins with it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/image.hpp"
#include "io/zip/zip_archive.hpp"

namespace vam::io::arrays {

inline constexpr std::uint64_t most_side = 1 << 16;       // values along an axis
inline constexpr std::uint64_t most_image = 1ULL << 28;   // values of a slice
inline constexpr std::uint64_t most_values = 1ULL << 40;  // of all

/// The type of its values and their order.
struct Head {
  char kind = 'f';  // b, i, u or f
  int bytes = 4;    // of a value: 1, 2, 4 or 8
  bool big_endian = false;
  bool fortran = false;                  // the first axis is the fastest
  std::array<std::uint64_t, 3> shape{};  // a plane is one slice
  [[nodiscard]] std::uint64_t values() const { return shape[0] * shape[1] * shape[2]; }
};

/// "3 x 4"; "one number" where there are no axes.
[[nodiscard]] std::string shape_text(const std::vector<std::uint64_t>& shape);

/// Two axes or three, the slowest first; more where the last are 1, as the only channel of a target of Dr.TVAM. Throws
/// for another number of axes, an empty axis, sizes beyond the limits.
void set_shape(std::vector<std::uint64_t> shape, Head& head);

/// `count` values of the head's type as floats; what is too large for a float becomes infinite.
void to_floats(const Head& head, const char* bytes, std::size_t count, float* to);

class Bytes {
 public:
  /// `read(to, size)` returns fewer only at the end.
  using Read = std::function<std::size_t(void*, std::size_t)>;
  explicit Bytes(Read read) : read_(std::move(read)) {}

  /// Throws where fewer are left.
  void take(void* to, std::size_t size);
  /// Up to and without the next line feed, and without a carriage return before it. Throws as take() for a line of
  /// more than 64 KiB.
  [[nodiscard]] std::string line();
  [[nodiscard]] bool ended();

 private:
  Read read_;
  std::size_t taken_ = 0;
};

/// The values front to back.
class Parser {
 public:
  /// Which axis of the array counts images, rows and columns, and whether from its end. Throws std::runtime_error.
  Parser(const Head& head, Bytes values, std::array<int, 3> axes, std::array<bool, 3> reversed = {});
  /// Images, rows, columns.
  [[nodiscard]] const std::array<std::size_t, 3>& size() const { return size_; }
  /// Image `k`, in ascending order. Throws std::runtime_error: cut off, more bytes than values, a value that is not
  /// finite.
  void next(Image& image);

 private:
  void take_floats(float* to, std::size_t count);
  void hold_all();
  void gather();
  void check(const Image& image) const;
  void require_end();

  Head head_;
  Bytes bytes_;
  std::array<std::size_t, 3> size_{};
  std::array<std::size_t, 3> stride_{};  // in values, from image to image, row to row, column to column
  std::array<bool, 3> reversed_{};
  bool streams_ = false;  // the images are as they come
  std::vector<char> raw_;
  std::vector<float> all_;  // where they are not
  std::vector<Image> some_;
  std::size_t done_ = 0;  // images
};

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
