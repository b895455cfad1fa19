// SPDX-License-Identifier: GPL-3.0-or-later
// Private to seal.cpp: XXH3 for the instruction set of the machine; the result is the same for all.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vam::io {

struct HashHalves {
  std::uint64_t high;
  std::uint64_t low;
};

/// Room for what XXH3 keeps between pieces.
struct alignas(64) HashState {
  unsigned char room[576];
};

struct HashKernels {
  HashHalves (*of)(const void* bytes, std::size_t size);
  void (*begin)(HashState& state);
  void (*add)(HashState& state, const void* bytes, std::size_t size);
  HashHalves (*end)(const HashState& state);
};

namespace baseline {
extern const HashKernels hash_kernels;
}
namespace avx2 {
extern const HashKernels hash_kernels;
}
namespace avx512 {
extern const HashKernels hash_kernels;
}

}  // namespace vam::io
