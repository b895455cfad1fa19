// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/private/hash_kernel.hpp"

#define XXH_INLINE_ALL  // all of it static, so that the linker mixes no levels
#ifdef __AVX512F__
#define XXH_VECTOR XXH_AVX2  // GCC 12 takes its own 512-bit intrinsics for uninitialized (bug 105593)
#endif
#include <xxhash.h>

namespace vam::io::VAM_SIMD {

HashHalves hash_bytes(const void* bytes, std::size_t size) {
  const XXH128_hash_t hash = XXH3_128bits(bytes, size);
  return {hash.high64, hash.low64};
}

}  // namespace vam::io::VAM_SIMD
