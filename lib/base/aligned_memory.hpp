// Memory of arrays that kernels work on.
#pragma once

#include <cstddef>

namespace vam {

/// Memory on cache-line boundaries; from 4 MiB on in huge pages where the system has them, because a column of pixels
/// touches a page a pixel. Blocks of that size that the bound on memory (base/memory.hpp) has no room for lie in
/// scratch files, whose pages the system writes to disk when it needs theirs: slower, with the same values. Throws
/// std::bad_alloc, and Fault::io where the disk has no room either.
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

/// Bytes of this process that lie in scratch files.
[[nodiscard]] std::size_t bytes_in_scratch_files();

}  // namespace vam
