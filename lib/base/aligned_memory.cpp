#include "base/aligned_memory.hpp"

#include <sys/mman.h>

#include <map>
#include <mutex>
#include <new>

#include "base/memory.hpp"
#include "base/scratch_file.hpp"

namespace vam {

namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t large = 2 * huge_page;
constexpr std::size_t spare = std::size_t{256} << 20;  // of the bound, for all that is not a large block

std::align_val_t alignment_of(std::size_t bytes) { return std::align_val_t{bytes < large ? 64 : huge_page}; }

/// The blocks that lie in files.
class Mapped {
 public:
  void* add(std::size_t bytes) {
    void* memory = ScratchFile().map(bytes);
    const std::lock_guard lock(mutex_);
    blocks_[memory] = bytes;
    total_ += bytes;
    return memory;
  }

  bool remove(void* memory) {
    const std::lock_guard lock(mutex_);
    const auto block = blocks_.find(memory);
    if (block == blocks_.end()) return false;
    munmap(memory, block->second);
    total_ -= block->second;
    blocks_.erase(block);
    return true;
  }

  [[nodiscard]] std::size_t total() {
    const std::lock_guard lock(mutex_);
    return total_;
  }

 private:
  std::mutex mutex_;
  std::map<void*, std::size_t> blocks_;
  std::size_t total_ = 0;
};

Mapped& mapped() {
  static Mapped blocks;
  return blocks;
}

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  if (bytes >= large && memory_left() < bytes + spare) return mapped().add(bytes);
  void* memory = ::operator new(bytes, alignment_of(bytes));
#ifdef MADV_HUGEPAGE
  if (bytes >= large) static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));  // a wish, no more
#endif
  return memory;
}

void free_aligned(void* memory, std::size_t bytes) {
  if (bytes >= large && mapped().remove(memory)) return;
  ::operator delete(memory, alignment_of(bytes));
}

std::size_t bytes_in_scratch_files() { return mapped().total(); }

}  // namespace vam
