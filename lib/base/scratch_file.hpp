// SPDX-License-Identifier: GPL-3.0-or-later
// What does not fit into memory: a file without a name that is gone with the process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace vam {

/// Lies in $TMPDIR, else in /var/tmp, which is on a disk where /tmp may be memory. Any thread may read while none
/// writes.
class ScratchFile {
 public:
  /// Throws Fault::no_output where no file can be created.
  ScratchFile();
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Both throw Fault::io: the folder is full, the disk fails.
  void write(std::uint64_t offset, const void* bytes, std::size_t size);
  void read(std::uint64_t offset, void* to, std::size_t size) const;

  /// The file's first `size` bytes as memory, zero at first, which outlives this object: munmap() frees memory and
  /// disk. The disk has room for all of them from here on. Throws Fault::io where it has not.
  [[nodiscard]] void* map(std::size_t size);

 private:
  std::string folder_;
  int descriptor_ = -1;
};

}  // namespace vam
