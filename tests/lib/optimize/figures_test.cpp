// SPDX-License-Identifier: GPL-3.0-or-later
// How slices become passes and jobs, and their figures those of a volume.
#include "optimize/run/private/jobs.hpp"
#include "optimize/run/slice_figures.hpp"
#include "optimize/target/schedule.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;

namespace {

model::DoseMetrics slice(std::int64_t part, std::int64_t void_, double ver, double iou, double cv, double pw,
                         double ipdr) {
  model::DoseMetrics m{.part = part, .void_ = void_, .ver = ver, .pw = pw, .ipdr = ipdr, .cv = cv, .iou = iou};
  return m;
}

void check_mean(const model::DoseMetrics& m) {
  CHECK(m.part == 40);
  CHECK(m.void_ == 120);
  CHECK(m.ver == doctest::Approx((2 * 4 + 12 + 2) / 160.0));
  CHECK(m.iou == doctest::Approx(0.65));
  CHECK(m.cv == doctest::Approx(std::sqrt(0.025)));  // root mean square
  CHECK(m.pw == -0.1);
  CHECK(m.ipdr == 0.6);
}

void check_pass(const Pass& pass, int first, int last, int low, int high) {
  CHECK(pass.first == first);
  CHECK(pass.last == last);
  CHECK(pass.low == low);
  CHECK(pass.high == high);
}

}  // namespace

TEST_CASE("figures of slices: means by voxel count, the worst window, the widest range") {
  SliceFigures one;
  one.add(slice(10, 30, 0.1, 0.8, 0.2, 0.3, 0.4), 2);
  SliceFigures other;
  other.add(slice(20, 20, 0.3, 0.5, 0.1, -0.1, 0.6));
  other.add(slice(0, 40, 0.05, 0.9, 0.9, -5, 9));  // no part: nothing but its void counts
  SliceFigures both = one;
  both.add(other);
  check_mean(both.mean());
  other.add(one);
  check_mean(other.mean());
  CHECK(SliceFigures().mean().ver == 0);
  CHECK(SliceFigures().mean().part == 0);
  SliceFigures empty;
  empty.add(slice(0, 10, 0.5, 0, 0, 0, 0));
  CHECK(empty.mean().ver == 0.5);
  CHECK(empty.mean().iou == 0);
}

TEST_CASE("a pass has as many slices as four slabs hold, those of its halo included") {
  check_pass(Division{true, 0}.from(0, 200), 0, 200, 0, 200);
  check_pass(Division{false, 0}.from(0, 100), 0, 64, 0, 64);
  check_pass(Division{false, 0}.from(64, 100), 64, 100, 64, 100);
  check_pass(Division{false, 3}.from(0, 100), 0, 58, 0, 61);
  check_pass(Division{false, 3}.from(10, 100), 10, 68, 7, 71);
  check_pass(Division{false, 3}.from(58, 100), 58, 100, 55, 100);
}

TEST_CASE("passes without a slice that is asked for are left out") {
  const Jobs every = every_slice(200, {false, 0});
  CHECK(every.passes.size() == 4);
  const Jobs jobs = make_jobs(every.schedule, {70, 130}, {false, 0});
  REQUIRE(jobs.passes.size() == 2);
  check_pass(jobs.passes[0], 64, 128, 64, 128);
  check_pass(jobs.passes[1], 128, 192, 128, 192);
  CHECK(std::count(jobs.multiplicity.begin(), jobs.multiplicity.end(), 1) == 60);
  CHECK(jobs.multiplicity[69] == 0);
  CHECK(jobs.multiplicity[129] == 1);
}

TEST_CASE("a slice like one not long ago shares its job") {
  std::vector<SliceDigest> slices;
  for (const char name : {'A', 'B', 'A', 'A', 'C', 'B', 'A', 'D', 'E', 'A'}) {
    slices.push_back({static_cast<std::uint64_t>(name), 0});
  }
  const Schedule schedule = make_schedule(slices, 1);  // one job between at most
  CHECK(schedule.job_of_slice == std::vector<int>{0, 1, 0, 0, 2, 1, 0, 3, 4, 5});
  CHECK(schedule.slice_of_job == std::vector<int>{0, 1, 4, 7, 8, 9});
  CHECK(schedule.last_slice == std::vector<int>{6, 5, 4, 7, 8, 9});
}

TEST_CASE("every value of a slice counts for its digest, and its place") {
  const std::vector<float> slice{1, 2, 3, 4, 5};
  const SliceDigest own = digest(slice);
  CHECK(digest(slice) == own);
  for (std::size_t i = 0; i < slice.size(); ++i) {
    std::vector<float> other = slice;
    other[i] += 1;
    CHECK(digest(other) != own);
  }
  CHECK(digest(std::vector<float>{1, 2, 5, 4, 3}) != own);
  CHECK(digest(std::vector<float>{1, 2, 3, 4}) != own);
  CHECK(digest(std::vector<float>{3}, digest(std::vector<float>{1, 2})) == digest(std::vector<float>{1, 2, 3}));
  CHECK(digest(slice, own) != own);
}
