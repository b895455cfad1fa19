// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/stream/private/hash_kernel.hpp"

#define XXH_INLINE_ALL  // all of it static, so that the linker mixes no levels
#ifdef __AVX512F__
#define XXH_VECTOR XXH_AVX2  // GCC 12 takes its own 512-bit intrinsics for uninitialized (bug 105593)
#endif
#include <xxhash.h>

namespace vam::io::VAM_SIMD {

namespace {

static_assert(sizeof(XXH3_state_t) == sizeof(HashState) && alignof(XXH3_state_t) == alignof(HashState));

// GCC 12 leaves the upper halves of registers in use at the end of XXH3's loop, which makes code without AVX slow.
void leave_vectors() {
#ifdef __AVX2__
  _mm256_zeroupper();
#endif
}

HashHalves halves(const XXH128_hash_t& hash) {
  leave_vectors();
  return {hash.high64, hash.low64};
}

HashHalves of(const void* bytes, std::size_t size) { return halves(XXH3_128bits(bytes, size)); }

void begin(HashState& state) { (void)XXH3_128bits_reset(reinterpret_cast<XXH3_state_t*>(&state)); }

void add(HashState& state, const void* bytes, std::size_t size) {
  (void)XXH3_128bits_update(reinterpret_cast<XXH3_state_t*>(&state), bytes, size);
  leave_vectors();
}

HashHalves end(const HashState& state) {
  return halves(XXH3_128bits_digest(reinterpret_cast<const XXH3_state_t*>(&state)));
}

}  // namespace

extern const HashKernels hash_kernels;
const HashKernels hash_kernels{of, begin, add, end};

}  // namespace vam::io::VAM_SIMD
