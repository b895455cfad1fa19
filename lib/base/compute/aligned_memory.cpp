// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/compute/aligned_memory.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <new>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/scratch_file.hpp"

namespace vam {

namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t large = 2 * huge_page;

std::atomic<std::uint64_t> kept_free{0};  // NOLINT: one per process, like the bound

/// Of the bound, for all that is not a large block.
std::uint64_t spare() { return std::min(std::uint64_t{256} << 20, memory_bound() / 8) + kept_free; }

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

std::atomic<bool> warned{false};  // NOLINT: once a process

void warn_once(const std::string& problem) {
  if (warned.exchange(true)) return;
  warn(problem +
       "; what does not fit is kept in scratch files in TMPDIR or /var/tmp, which is slower; allow more with " +
       memory_bound_name());
}

Mapped& mapped() {
  static Mapped blocks;
  return blocks;
}

}  // namespace

void* allocate_aligned(std::size_t bytes) {
  if (bytes >= large) {
    const std::uint64_t left = memory_left();
    if (left < bytes + spare()) {
      try {
        void* memory = mapped().add(bytes);
        warn_once(in_gib(static_cast<double>(left)) + " of memory are left");
        return memory;
      } catch (const Error&) {
        if (bytes > left) throw;
      }
    }
  }
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

void keep_free(double bytes) { kept_free = static_cast<std::uint64_t>(bytes); }

void warn_of_scratch_files(double bytes, const std::string& subject) {
  const auto left = static_cast<double>(memory_left());
  if (bytes <= left) return;
  warn_once(subject + ": needs " + in_gib(bytes) + " of memory, but " + in_gib(left) + " are left");
}

std::size_t bytes_in_scratch_files() { return mapped().total(); }

}  // namespace vam
