// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/compute/memory.hpp"

#include <stdlib.h>
#include <sys/resource.h>

#include <cstring>
#include <memory>

#include "base/compute/aligned_memory.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;  // which has an allocator of its own
#else
constexpr bool sanitized = false;
#endif
constexpr std::uint64_t mib = std::uint64_t{1} << 20;

// The bound is the process', and other cases follow.
struct Bounded {
  explicit Bounded(std::uint64_t bytes) { bound_memory(bytes, "--memory"); }
  ~Bounded() { bound_memory(std::uint64_t{1} << 60); }
  Bounded(const Bounded&) = delete;
  Bounded& operator=(const Bounded&) = delete;
};

std::string refusal(double bytes) {
  return error_of([&] { require_memory(bytes, "part.vdb: 9 x 9 x 9 voxels", "use larger voxels"); }, Fault::memory);
}

}  // namespace

TEST_CASE("a need beyond the bound is refused with both numbers and a remedy") {
  const Bounded bounded(2048 * mib);
  CHECK(refusal(1e9) == "no error");
  const std::string line = refusal(12.5 * 1024 * static_cast<double>(mib));
  CHECK(line.starts_with("part.vdb: 9 x 9 x 9 voxels: needs 12.5 GiB of memory, but --memory leaves "));  // most of 2
  CHECK(line.ends_with("; use larger voxels, or allow more with --memory"));
  CHECK(refusal(1e40) != "no error");
  const Bounded small(1);
  CHECK(has(refusal(1e9), " GiB is used up; use larger voxels"));
}

TEST_CASE("what the machine has free is the bound where none is given") {
  bound_memory(0);
  const std::uint64_t left = memory_left();
  CHECK(left > 16 * mib);
  CHECK(left < std::uint64_t{1} << 50);
  CHECK(has(refusal(1e15), " are free; "));
  bound_memory(std::uint64_t{1} << 60);
}

TEST_CASE("a large allocation beyond the bound throws before it is made") {
  if (sanitized) return;
  const Bounded bounded(1024 * mib);
  CHECK_NOTHROW(std::vector<char>(64 * mib));
  try {
    const std::vector<char> too_many(4096 * mib);
    FAIL("4 GiB were given");
  } catch (const OutOfMemory& refused) {
    const std::string line = refused.what();
    CHECK(line.starts_with("needs 4 GiB of memory in addition to the 0."));
    CHECK(line.ends_with("--memory allows 1 GiB"));
  }
  CHECK_THROWS_AS(std::make_unique<char[]>(std::size_t{1} << 62), OutOfMemory);
}

TEST_CASE("what the system refuses is told with its limit, and how to raise it") {
  CHECK(has(std::string(vam::OutOfMemory(0).what()), "; end other programs"));
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_AS, &before) == 0);
  rlimit most = before;
  most.rlim_cur = std::uint64_t{1} << 50;
  REQUIRE(setrlimit(RLIMIT_AS, &most) == 0);
  const std::string unknown = vam::OutOfMemory(0).what(), known = vam::OutOfMemory(std::uint64_t{5} << 20).what();
  REQUIRE(setrlimit(RLIMIT_AS, &before) == 0);
  CHECK(unknown.starts_with("no memory is left: "));
  CHECK(known.starts_with("needs 5 MiB of memory more: "));
  CHECK(known.ends_with(" MiB of addresses are in use, the limit is 1.074e+09 MiB; raise it (ulimit -v)"));
}

TEST_CASE("small allocations are counted, and memory that was freed is not") {
  if (sanitized) return;
  const Bounded bounded(512 * mib);
  std::vector<std::unique_ptr<std::vector<char>>> kept;
  const auto fill = [&] {
    for (int i = 0; i < 1024; ++i) kept.push_back(std::make_unique<std::vector<char>>(mib, 'x'));
  };
  CHECK_THROWS_AS(fill(), OutOfMemory);
  CHECK(kept.size() > 300);
  kept.clear();
  CHECK_NOTHROW(std::vector<char>(256 * mib, 'x'));
}

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
