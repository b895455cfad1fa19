// SPDX-License-Identifier: GPL-3.0-or-later
// Private to sandboxed_reader.cpp and its two ends: the shared memory and the socket.
#pragma once

#include <cstddef>
#include <cstdint>

#include "io/stream/sandboxed_reader.hpp"

namespace vam::io {

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
