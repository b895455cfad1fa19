// SPDX-License-Identifier: GPL-3.0-or-later
// What the bounds of the child do: an allocation of a GiB throws. A sanitizer's `new` would end the program instead.
#include <cstdlib>
#include <new>

void* operator new(std::size_t bytes) {
  void* memory = bytes < std::size_t{1} << 30 ? std::malloc(bytes == 0 ? 1 : bytes) : nullptr;
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
