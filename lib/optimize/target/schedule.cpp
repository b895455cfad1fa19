// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/target/schedule.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>

#include "base/index.hpp"

namespace vam::optimize {

SliceDigest digest(std::span<const float> slice, SliceDigest seed) {
  constexpr std::uint64_t prime_a = 0x9FB21C651E98DF25U;  // odd constants with well mixed bits (xxHash, wyhash)
  constexpr std::uint64_t prime_b = 0xA0761D6478BD642FU;
  for (std::size_t i = 0; i < slice.size(); i += 2) {
    std::uint64_t word = 0;
    std::memcpy(&word, slice.data() + i, std::min<std::size_t>(2, slice.size() - i) * sizeof(float));
    seed[0] = std::rotl((seed[0] ^ word) * prime_a, 29);
    seed[1] = std::rotl((seed[1] + word) * prime_b, 37) ^ seed[0];
  }
  return seed;
}

Schedule make_schedule(std::span<const SliceDigest> slices, int keep) {
  struct Known {
    int job;
    int jobs_then;  // how many jobs there were when it was last used
  };
  Schedule schedule;
  std::map<SliceDigest, Known> known;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    const int jobs = count_of(schedule.slice_of_job);
    const auto found = known.find(slices[k]);
    int job = jobs;
    if (found != known.end() && jobs - found->second.jobs_then <= keep) {
      job = found->second.job;
      schedule.last_slice[job] = static_cast<int>(k);
    } else {
      schedule.slice_of_job.push_back(static_cast<int>(k));
      schedule.last_slice.push_back(static_cast<int>(k));
    }
    known[slices[k]] = {job, count_of(schedule.slice_of_job)};
    schedule.job_of_slice.push_back(job);
  }
  return schedule;
}

}  // namespace vam::optimize
