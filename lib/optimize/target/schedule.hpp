// SPDX-License-Identifier: GPL-3.0-or-later
// Identical slices are computed once: which slice is computed as which job.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vam::optimize {

using SliceDigest = std::array<std::uint64_t, 2>;

/// 128-bit digest of a slice's values: two slices with equal digests are equal, short of an accident of 2^-100.
[[nodiscard]] SliceDigest digest(std::span<const float> slice,
                                 SliceDigest seed = {0x9E3779B97F4A7C15U, 0xC2B2AE3D27D4EB4FU});

struct Schedule {
  std::vector<int> job_of_slice;
  std::vector<int> slice_of_job;  // the first slice that needs it; ascending
  std::vector<int> last_slice;    // the last one: then the result may be forgotten
};

/// Slices in order; a slice takes the result of an earlier equal one if since that one's last use at most `keep` other
/// jobs have begun, so that at most about `keep` finished results must be held for later.
[[nodiscard]] Schedule make_schedule(std::span<const SliceDigest> slices, int keep);

}  // namespace vam::optimize
