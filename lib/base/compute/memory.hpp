// SPDX-License-Identifier: GPL-3.0-or-later
// How much memory this process may take: a chosen bound, else what the machine has free.
#pragma once

#include <array>
#include <cstdint>
#include <new>
#include <string>

namespace vam {

/// Bounds the memory of the process from here on; 0: what it has and what the machine has free (MemAvailable, or what
/// its control groups leave if that is less). From then on `new` throws OutOfMemory instead of exceeding it: looked up
/// every 16 MiB that a thread takes. Never called: no bound. Messages call the bound by its name, which must last.
void bound_memory(std::uint64_t bytes, const char* name = "a higher limit");

/// Bytes until the bound; without one, those the machine has free.
[[nodiscard]] std::uint64_t memory_left();

/// What a tool knows before it begins. Throws Fault::memory unless `bytes` more fit: "part.vdb (9000 x 9000 x 4000
/// voxels): needs 12 GiB of memory, but 8 GiB are free; `remedy`, or allow more with `name`". Bytes are a double
/// because products of sizes in a file may exceed all integers.
void require_memory(double bytes, const std::string& subject, const std::string& remedy);

/// The bound; without one, what the process has and the machine has free.
[[nodiscard]] std::uint64_t memory_bound();

/// "12 GiB".
[[nodiscard]] std::string in_gib(double bytes);

/// What --memory is called in messages.
[[nodiscard]] const char* memory_bound_name();

/// Memory that was refused; what() has the numbers.
class OutOfMemory : public std::bad_alloc {
 public:
  OutOfMemory(std::uint64_t wanted, std::uint64_t has, std::uint64_t most) noexcept;
  /// What the system refused, named from 1 MiB on; 0: what a library asked for, which is not known.
  explicit OutOfMemory(std::uint64_t wanted) noexcept;
  [[nodiscard]] const char* what() const noexcept override { return text_.data(); }

 private:
  std::array<char, 200> text_{};  // there may be no memory for more
};

}  // namespace vam
