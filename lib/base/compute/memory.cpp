// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/compute/memory.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam {

namespace {

constexpr std::uint64_t everything = std::numeric_limits<std::uint64_t>::max();
constexpr std::size_t unseen_bytes = std::size_t{1} << 24;  // that a thread takes between two looks

std::atomic<std::uint64_t> bound{everything};  // NOLINT: one per process, like the memory it bounds
std::atomic<bool> chosen{false};               // NOLINT: by the user
const char* bound_name = "a higher limit";     // NOLINT: what messages call it

constexpr double bytes_per_gib = 1024.0 * 1024.0 * 1024.0;

struct Pages {
  std::uint64_t addresses = 0, in_memory = 0, shared = 0;
};

// Without an allocation, as `new` asks; 0 where the system does not say.
Pages pages_of_process() {
  std::array<char, 128> line{};
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return {};
  const ssize_t size = read(file, line.data(), line.size() - 1);
  close(file);
  Pages pages;
  const bool whole =
      size > 0 && std::sscanf(line.data(), "%lu %lu %lu", &pages.addresses, &pages.in_memory, &pages.shared) == 3;
  return whole ? pages : Pages{};
}

std::uint64_t bytes_of(std::uint64_t pages) { return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)); }

// Private pages in memory.
std::uint64_t taken() {
  const Pages pages = pages_of_process();
  return bytes_of(pages.in_memory - std::min(pages.in_memory, pages.shared));
}

// The number in a file, or behind a key in it; `everything` where there is none ("max").
std::uint64_t number_in(const std::string& path, const std::string& key = "") {
  std::ifstream file(path);
  std::uint64_t number = 0;
  if (key.empty()) return file >> number ? number : everything;
  for (std::string word; file >> word;) {
    if (word == key) return file >> number ? number : everything;
  }
  return everything;
}

// What a control group leaves; its page cache gives way.
std::uint64_t left_in_group(const std::string& folder, const char* most_file, const char* used_file) {
  const std::uint64_t most = number_in(folder + most_file);
  const std::uint64_t used = number_in(folder + used_file);
  if (most == everything || used == everything) return everything;
  const std::uint64_t cache = number_in(folder + "/memory.stat", "inactive_file");
  const std::uint64_t kept = cache == everything ? used : used - std::min(used, cache);
  return most - std::min(most, kept);
}

// Of this process' groups and those that hold them, in both versions of the kernel's interface.
std::uint64_t left_in_groups() {
  std::uint64_t left = left_in_group("/sys/fs/cgroup/memory", "/memory.limit_in_bytes", "/memory.usage_in_bytes");
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    if (!line.starts_with("0::/")) continue;
    for (std::string path = line.substr(3);; path.erase(path.rfind('/'))) {
      left = std::min(left, left_in_group("/sys/fs/cgroup" + path, "/memory.max", "/memory.current"));
      if (path.find('/') == std::string::npos) break;
    }
  }
  return left;
}

std::uint64_t free_of_machine() {
  const std::uint64_t kib = number_in("/proc/meminfo", "MemAvailable:");
  return std::min(kib == everything ? everything : kib << 10, left_in_groups());
}

std::uint64_t left_below(std::uint64_t most) { return most - std::min(most, taken()); }

[[maybe_unused]] void admit(std::size_t bytes) {  // a sanitizer has its own
  static thread_local std::size_t unseen = 0;
  unseen += std::min(bytes, unseen_bytes);
  if (unseen < unseen_bytes) return;
  unseen = 0;
  const std::uint64_t most = bound.load(std::memory_order_relaxed);
  if (most == everything || bytes <= left_below(most)) return;
  malloc_trim(0);  // what was freed may still be counted
  if (bytes > left_below(most)) throw OutOfMemory(bytes, taken(), most);
}

}  // namespace

OutOfMemory::OutOfMemory(std::uint64_t wanted, std::uint64_t has, std::uint64_t most) noexcept {
  const auto of = [](std::uint64_t bytes) { return static_cast<double>(bytes) / bytes_per_gib; };
  std::snprintf(text_.data(), text_.size(),
                "needs %.3g GiB of memory in addition to the %.3g GiB in use; %s%s %.3g GiB%s", of(wanted), of(has),
                chosen ? bound_name : "the machine had", chosen ? " allows" : "", of(most), chosen ? "" : " free");
}

OutOfMemory::OutOfMemory(std::uint64_t wanted) noexcept {
  const auto mib = [](std::uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); };
  const double has = mib(bytes_of(pages_of_process().addresses));
  rlimit most{};
  const bool limited = getrlimit(RLIMIT_AS, &most) == 0 && most.rlim_cur != RLIM_INFINITY;
  std::array<char, 64> start{"no memory is left"}, end{"the system gives no more; end other programs"};
  if (wanted >= 1 << 20) std::snprintf(start.data(), start.size(), "needs %.3g MiB of memory more", mib(wanted));
  if (limited) {
    std::snprintf(end.data(), end.size(), "the limit is %.4g MiB; raise it (ulimit -v)",
                  mib(static_cast<std::uint64_t>(most.rlim_cur)));
  }
  std::snprintf(text_.data(), text_.size(), "%s: %.4g MiB of addresses are in use, %s", start.data(), has, end.data());
}

void bound_memory(std::uint64_t bytes, const char* name) {
  bound_name = name;
  chosen = bytes > 0;
  bound = bytes > 0 ? bytes : taken() + free_of_machine();
}

std::uint64_t memory_bound() {
  const std::uint64_t most = bound;
  return most == everything ? taken() + free_of_machine() : most;
}

const char* memory_bound_name() { return bound_name; }

std::string in_gib(double bytes) { return format_number(bytes / bytes_per_gib, 3) + " GiB"; }

std::uint64_t memory_left() {
  const std::uint64_t most = bound;
  if (most == everything) return free_of_machine();
  return left_below(most);
}

void require_memory(double bytes, const std::string& subject, const std::string& remedy) {
  const auto left = static_cast<double>(memory_left());
  if (bytes <= left) return;
  throw Error{Fault::memory,
              subject + ": needs " + in_gib(bytes) + " of memory, but " +
                  (!chosen    ? in_gib(left) + " are free"
                   : left > 0 ? bound_name + (" leaves " + in_gib(left))
                              : bound_name + (" of " + in_gib(static_cast<double>(bound)) + " is used up")) +
                  "; " + remedy + ", or allow more with " + bound_name};
}

}  // namespace vam

// A sanitizer has its own.
#ifndef VAM_SANITIZED

namespace {

void* given(void* memory, std::size_t bytes) {
  if (memory == nullptr) throw vam::OutOfMemory(bytes);
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) {
  vam::admit(bytes);
  return given(std::malloc(bytes == 0 ? 1 : bytes), bytes);
}

void* operator new(std::size_t bytes, std::align_val_t alignment) {
  vam::admit(bytes);
  const auto unit = static_cast<std::size_t>(alignment);
  return given(std::aligned_alloc(unit, (bytes + unit - 1) / unit * unit), bytes);
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

#endif
