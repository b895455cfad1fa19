// SPDX-License-Identifier: GPL-3.0-or-later
// Private to sandboxed_reader.cpp and its two ends: what a child may do, the shared memory and the socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include "io/stream/sandboxed_reader.hpp"

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

inline constexpr std::size_t slot_bytes = std::size_t{1} << 19;
inline constexpr std::uint32_t last_word = 0xffffffff;  // in place of a slot's size: the child's verdict follows

struct SharedBuffers {
  char* memory = nullptr;  // two slots
  int socket = -1;  // up: a 32-bit size for each slot that is handed over, in turn; down: a byte for each one read
  std::uint32_t turn = 0;  // slots handed over (child) or received (parent)
  [[nodiscard]] char* slot() const { return memory + (turn % 2) * slot_bytes; }
};

/// Thrown by Receiver::get() when the child has ended before.
struct ChildEnded {};

/// The whole of it, over interruptions by signals; false when the other end has gone.
[[nodiscard]] bool read_fully(int socket, void* to, std::size_t size);
/// With write(), as the child may not call send(); its signal then ends the child.
[[nodiscard]] bool write_fully(int socket, const void* from, std::size_t size);

}  // namespace vam::io
