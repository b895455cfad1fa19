// SPDX-License-Identifier: GPL-3.0-or-later
// Memory of arrays that kernels work on.
#pragma once

#include <cstddef>
#include <string>

namespace vam {

/// Memory on cache-line boundaries; from 4 MiB on in huge pages where the system has them, because a column of pixels
/// touches a page a pixel. Blocks of that size that the bound on memory (base/compute/memory.hpp) has no room for lie
/// in scratch files, whose pages the system writes to disk when it needs the memory: slower, with the same values, and
/// with one line of warning for the first. Throws std::bad_alloc, and as ScratchFile does where the disk has no room
/// either.
[[nodiscard]] void* allocate_aligned(std::size_t bytes);
void free_aligned(void* memory, std::size_t bytes);

template <class T>
struct CacheAligned {
  using value_type = T;
  CacheAligned() = default;
  template <class U>
  explicit CacheAligned(const CacheAligned<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(allocate_aligned(n * sizeof(T))); }
  void deallocate(T* p, std::size_t n) { free_aligned(p, n * sizeof(T)); }
  bool operator==(const CacheAligned&) const = default;
};

/// What a tool knows before it begins: so many bytes will be needed beside large blocks, which leave them free.
void keep_free(double bytes);

/// What a tool knows before it begins: the warning with both numbers, if `bytes` more do not fit.
void warn_of_scratch_files(double bytes, const std::string& subject);

/// Bytes of this process that lie in scratch files.
[[nodiscard]] std::size_t bytes_in_scratch_files();

}  // namespace vam
