// SPDX-License-Identifier: GPL-3.0-or-later
// The two ends of what a child sends.
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "io/stream/private/sandbox.hpp"

namespace vam::io {

bool read_fully(int socket, void* to, std::size_t size) {
  for (auto* next = static_cast<char*>(to); size > 0;) {
    const ssize_t got = ::read(socket, next, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    next += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

bool write_fully(int socket, const void* from, std::size_t size) {
  for (const auto* next = static_cast<const char*>(from); size > 0;) {
    const ssize_t sent = ::write(socket, next, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    next += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

// ---- the child ----------------------------------------------------------------------------------------------------

void Sender::put(const void* bytes, std::size_t size) {
  for (const auto* from = static_cast<const char*>(bytes); size > 0;) {
    if (filled_ == 0) acquire();
    const std::size_t step = std::min(size, slot_bytes - filled_);
    std::memcpy(slots_.slot() + filled_, from, step);
    filled_ += step;
    from += step;
    size -= step;
    if (filled_ == slot_bytes) submit();
  }
}

void Sender::flush() {
  if (filled_ > 0) submit();
}

// The first two slots are free. A parent that has gone needs nothing more.
void Sender::acquire() {
  char read = 0;
  if (slots_.turn >= 2 && !read_fully(slots_.socket, &read, 1)) _exit(0);
}

void Sender::submit() {
  const auto size = static_cast<std::uint32_t>(filled_);
  if (!write_fully(slots_.socket, &size, sizeof size)) _exit(0);
  ++slots_.turn;
  filled_ = 0;
}

// ---- the parent ---------------------------------------------------------------------------------------------------

// The slot that was read goes back, where the child is still there to want it; the next one comes.
void Receiver::next_slot() {
  const char read = 0;
  if (holds_) (void)send(slots_.socket, &read, 1, MSG_NOSIGNAL);
  holds_ = false;
  std::uint32_t filled = 0;
  if (!read_fully(slots_.socket, &filled, sizeof filled)) throw ChildEnded{};
  if (filled == last_word) judged_ = true;
  if (filled > slot_bytes) throw ChildEnded{};
  slot_ = slots_.slot();
  left_ = filled;
  holds_ = true;
  ++slots_.turn;
}

void Receiver::get(void* to, std::size_t size) {
  for (auto* next = static_cast<char*>(to); size > 0;) {
    if (left_ == 0) next_slot();
    const std::size_t step = std::min(size, left_);
    std::memcpy(next, slot_, step);
    slot_ += step;
    left_ -= step;
    next += step;
    size -= step;
  }
}

bool Receiver::drain() {
  try {
    while (!judged_) next_slot();
  } catch (const ChildEnded&) {
  }
  return judged_;
}

std::uint64_t Receiver::get_count(std::uint64_t limit) {
  const auto count = get<std::uint64_t>();
  if (count > limit) throw ChildEnded{};
  return count;
}

}  // namespace vam::io
