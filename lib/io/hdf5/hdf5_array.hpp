// SPDX-License-Identifier: GPL-3.0-or-later
// An array of an HDF5 file as images, one after the other: the projections of a DXchange or NXtomo (NeXus) file, or any
// dataset of numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/hdf5/stated_views.hpp"

/// "2 x 3 x 4"
namespace vam::io::hdf5 {
[[nodiscard]] std::string shape_text(const std::vector<std::uint64_t>& shape);
}

namespace vam::io {

/// A file's bytes, which outlive what reads them: in memory where that is set, else of a descriptor that can be sought.
struct Hdf5Bytes {
  const char* memory = nullptr;
  int descriptor = -1;
  std::uint64_t size = 0;
};

struct Hdf5Options {
  std::string dataset;               // its path; empty: that of the file's convention, or the only one of 3 dimensions
  std::array<int, 3> axes{0, 1, 2};  // which axis counts the images, the rows and the columns
  bool projections = false;          // the rows are stage angles: what the file states about them counts
  bool own_order = false;            // of projections, the order of the file's convention goes before `axes`
  std::uint64_t memory = std::uint64_t{1} << 30;  // for the images that are held, in bytes
};

/// Before the bytes are parsed in a process that can open no file. Throws Fault::absent where libhdf5 is not installed.
void load_hdf5();

/// Reads images front to back in any order of the axes, many at a time. What libhdf5 unpacks is read (gzip, shuffle,
/// szip), of integers, floats and booleans of any size and byte order. Throws Error that begins with `name`: data
/// (truncated, damaged, not numbers, values in other files, another number of dimensions), usage (several datasets and
/// none named, none of that name), with the datasets that are there.
/// The conventions are those of [formats: Arrays].
class Hdf5Array {
 public:
  Hdf5Array(const Hdf5Bytes& bytes, const Hdf5Options& options, const std::string& name);
  ~Hdf5Array();
  /// Images, rows, columns.
  [[nodiscard]] const std::array<std::uint64_t, 3>& size() const;
  /// Of projections.
  [[nodiscard]] const StatedViews& views() const;
  /// The values as floats of this machine, image by image; fewer than `size` bytes only at the end.
  std::size_t read(void* to, std::size_t size);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::io
