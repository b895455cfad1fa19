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

namespace baseline {
[[nodiscard]] HashHalves hash_bytes(const void* bytes, std::size_t size);
}
namespace avx2 {
[[nodiscard]] HashHalves hash_bytes(const void* bytes, std::size_t size);
}
namespace avx512 {
[[nodiscard]] HashHalves hash_bytes(const void* bytes, std::size_t size);
}

}  // namespace vam::io
