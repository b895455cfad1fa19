// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/compute/aligned_memory.hpp"

#include <stdlib.h>

#include <cstring>

#include "base/compute/memory.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

constexpr std::size_t mib = std::size_t{1} << 20;

// The bound is the process', and other cases follow.
struct Bounded {
  explicit Bounded(std::uint64_t bytes) { bound_memory(bytes, "--memory"); }
  ~Bounded() { bound_memory(std::uint64_t{1} << 60); }
  Bounded(const Bounded&) = delete;
  Bounded& operator=(const Bounded&) = delete;
};

}  // namespace

TEST_CASE("blocks that do not fit in the bound lie in scratch files, and keep their values") {
  const Bounded bounded(4 * mib);  // less than a block
  auto* first = static_cast<char*>(allocate_aligned(8 * mib));
  auto* second = static_cast<char*>(allocate_aligned(8 * mib));
  CHECK(bytes_in_scratch_files() == 16 * mib);
  CHECK(reinterpret_cast<std::uintptr_t>(first) % 64 == 0);
  std::memset(first, 1, 8 * mib);
  std::memset(second, 2, 8 * mib);
  CHECK(first[8 * mib - 1] == 1);
  CHECK(second[0] == 2);
  free_aligned(first, 8 * mib);
  CHECK(bytes_in_scratch_files() == 8 * mib);
  free_aligned(second, 8 * mib);
  CHECK(bytes_in_scratch_files() == 0);
}

TEST_CASE("small blocks, and those that fit, lie in memory") {
  const Bounded tight(4 * mib);
  void* small = allocate_aligned(mib);
  CHECK(bytes_in_scratch_files() == 0);
  free_aligned(small, mib);
  const Bounded wide(std::uint64_t{1} << 40);
  void* large = allocate_aligned(8 * mib);
  CHECK(bytes_in_scratch_files() == 0);
  free_aligned(large, 8 * mib);
}

TEST_CASE("a folder without room for scratch files is an error that names it") {
  const Bounded bounded(4 * mib);  // less than a block
  const char* former = getenv("TMPDIR");
  const std::string kept = former != nullptr ? former : "";
  setenv("TMPDIR", "/proc", 1);
  CHECK_THROWS_WITH_AS(static_cast<void>(allocate_aligned(8 * mib)),
                       doctest::Contains("/proc: cannot create a scratch file"), Error);
  former != nullptr ? setenv("TMPDIR", kept.c_str(), 1) : unsetenv("TMPDIR");
  CHECK(bytes_in_scratch_files() == 0);
}
