// SPDX-License-Identifier: GPL-3.0-or-later
// The slices that decide the exposure.
#include "optimize/run/limited_by.hpp"

#include "base/text/json.hpp"
#include "lib/optimize/volumes.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace volumes;

namespace {

double height_mm(int k) { return 0.5 * k; }

}  // namespace

TEST_CASE("of each demand the slice that makes it, at its height, beside the median slice") {
  const std::vector<SliceDemand> asked{{}, {0.9, 0.5, 1}, {0.8, 0.7, 2}, {0.85, 0.6, 4}};
  const Json list = limited_by(asked, height_mm);
  REQUIRE(list.size() == 3);
  const auto is = [&](std::size_t i, const char* what, double z_mm, double value, double middle) {
    CHECK(list[i]["what"] == what);
    CHECK(list[i]["z_mm"] == z_mm);
    CHECK(list[i]["value"] == value);
    CHECK(list[i]["median"] == middle);
  };
  is(0, "peak", 1.5, 4, 2);
  is(1, "part", 1, 0.8, 0.85);
  is(2, "void", 1, 0.7, 0.6);
  CHECK(list[0]["why"] ==
        "the slice at z = 1.5 mm has the brightest pixel, which is shown at full grey and determines "
        "the duration: 4 (median slice 2)");
  CHECK(limited_by({}, height_mm).empty());
}

TEST_CASE("a slice that needs more light than the others is found, whichever slices are alike") {
  const auto easy = vam::oracle::wheel(size);
  const auto hard = vam::oracle::resolution_target(size);
  const auto result = run({easy, easy, hard, easy});
  const auto& asked = result.outcome.demands;
  REQUIRE(asked.size() == 4);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const auto& values = result.images[k].values;
    CHECK(asked[k].peak == static_cast<double>(*std::max_element(values.begin(), values.end())));
  }
  CHECK(asked[0].min_part == asked[3].min_part);
  CHECK(asked[2].min_part < asked[0].min_part);
  CHECK(asked[2].max_void > asked[0].max_void);
  CHECK(limited_by(asked, height_mm)[1]["z_mm"] == 1);
}
