// SPDX-License-Identifier: GPL-3.0-or-later
// Private to sandboxed_reader.cpp: what a child may do.
#pragma once

#include <cstdint>
#include <initializer_list>

namespace vam::io {

struct ResourceBounds {
  std::uint64_t memory_bytes = 0;  // in addition to what the process has
  std::uint64_t cpu_s = 0;
  bool scarce = false;  // the memory is all that this process has left, not what such a file may take
};

/// For a file of that size, 0: not known, whose contents may unpack to more.
[[nodiscard]] ResourceBounds bounds_of(std::uint64_t file_bytes, std::uint64_t unpacked_bytes);

/// Makes the calling process, a fresh child, end with its parent, gives it the bounds and takes away every descriptor
/// but `kept`, every signal handler and, where the kernel has seccomp, every system call that is not needed to compute,
/// to allocate, and to read and write these descriptors; they fail with EPERM then. False where a lower limit of
/// addresses was in force.
[[nodiscard]] bool confine(const ResourceBounds& bounds, int parent, std::initializer_list<int> kept);

}  // namespace vam::io
