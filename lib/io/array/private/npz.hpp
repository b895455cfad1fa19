// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: the arrays of a .npz, which is a zip archive of .npy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "io/array/private/array_head.hpp"

struct zip;
struct zip_file;

namespace vam::io::arrays {

/// One array of an archive in memory, unpacked as it is read.
class PackedArray {
 public:
  /// `name` without .npy; empty: the only one. The bytes must outlive it. Throws Error that begins with `file`: data
  /// (no archive, damaged, no array), usage (several and no name; no array of that name), with the names that are
  /// there.
  PackedArray(std::string_view bytes, const std::string& name, const std::string& file);
  /// Throws Fault::data where it has fewer bytes than the values take that its header promises; to unpack what is there
  /// may take minutes.
  void require(const Head& head) const;
  /// Fewer than `size` only at the end. Throws Fault::data where the archive is damaged.
  std::size_t read(void* to, std::size_t size);

 private:
  struct Close {
    void operator()(zip* archive) const;
    void operator()(zip_file* file) const;
  };
  std::string file_;
  std::unique_ptr<zip, Close> archive_;
  std::unique_ptr<zip_file, Close> array_;
  std::uint64_t size_ = 0;  // bytes, unpacked
};

}  // namespace vam::io::arrays
