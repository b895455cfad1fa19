// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of other programs as images one after the other: NumPy's .npy and .npz, HDF5, NRRD as vam-view writes it,
// TIFF of several pages; and those that NumPy reads.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include "base/image.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

/// Images, rows and columns.
struct ArraySize {
  int images = 0;
  int rows = 0;
  int columns = 0;
};

struct ArrayOptions {
  std::string name;                  // of the array in a .npz or HDF5 file that holds several
  std::array<int, 3> axes{0, 1, 2};  // which axis of the array counts the images, the rows and the columns
  std::array<bool, 3> reversed{};    // and whether from its end
};

/// Reads an array of 2 or 3 axes, beside last ones of 1, front to back, parsed in a child; what is not finite as float
/// is refused. Where images, rows and columns are the array's own order, in constant memory (.npz, TIFF and HDF5 from a
/// pipe: that of the file); else all of it is held. "-" is stdin. Throws Error: no_input, io, data (none of these,
/// truncated, damaged, objects, another number of axes, too large, not finite), usage (no array of that name), absent
/// (libhdf5).
class ArrayReader {
 public:
  ArrayReader(const std::string& path, const ArrayOptions& options);
  ~ArrayReader();
  [[nodiscard]] const ArraySize& size() const;
  /// The edge of a volume's voxels; 0: not stated, as only NRRD does.
  [[nodiscard]] double voxel_mm() const;
  /// Are they pages of images (TIFF), whose rows are counted from the top?
  [[nodiscard]] bool has_pages() const;
  /// The next image; false after the last.
  bool next(Image& image);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes images as .npy of little-endian floats, one after the other; size.images of them must follow. "-" is stdout.
/// A file appears at commit(). Throws Error: no_output, io.
class ArrayWriter {
 public:
  ArrayWriter(const std::string& path, const ArraySize& size);
  /// `count` values, row by row.
  void write(const float* values, std::size_t count);
  void commit();

 private:
  OutputFile file_;
};

}  // namespace vam::io
