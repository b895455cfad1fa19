// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/exposure.hpp"

#include "testing.hpp"

using namespace vam;
using namespace vam::session;

namespace {

/// Of light whose largest value is 2; peak 0: it is not read yet.
Exposure exposure(const model::Metadata& facts, double peak = 2, const GivenExposure& given = {}) {
  model::StackInfo info;
  info.extra = facts;
  model::Printer printer;
  printer.stage.turns = 4;
  return exposure_of("light", info, printer, peak, given);
}

}  // namespace

TEST_CASE("an exposure is that of the plan, else of stage.turns with the largest value at full intensity") {
  CHECK(exposure({}).turns == 4);
  CHECK(exposure({}).full_scale == 2);
  CHECK_FALSE(exposure({}).planned);
  CHECK(exposure({}, 0).full_scale == 0);
  const Exposure planned = exposure({{"vam:full_scale", "0.5"}, {"vam:shown_turns", "3"}}, 0);
  CHECK(planned.turns == 3);
  CHECK(planned.planned);
  CHECK(planned.full_scale == 0.5);
  CHECK(exposure({{"vam:shown_turns", "3"}}, 2, {.turns = 5}).turns == 5);
  CHECK_FALSE(exposure({{"vam:shown_turns", "3"}}, 2, {.turns = 5}).planned);
  for (const char* wrong : {"0", "-1", "1e7", "much"})
    CHECK(error_of([&] { (void)exposure({{"vam:full_scale", wrong}}); }, Fault::data).starts_with("light: "));
}

TEST_CASE("light whose poses return is shown for the planned turns, too") {
  model::StackInfo info;
  info.height = 4;
  info.angle_step_deg = 90;
  info.poses.resize(4);
  CHECK(exposure_of("light", info, {}, 2).turns == 1);
  info.extra["vam:shown_turns"] = "3";
  CHECK(exposure_of("light", info, {}, 2).turns == 3);
}

TEST_CASE("an exposure that is found late fits in the place of one that is unknown") {
  model::Metadata early, late;
  state_exposure(early, 0, 0);
  CHECK_FALSE(exposure(early).planned);
  CHECK(exposure(early, 0).full_scale == 0);
  for (const double value : {1e-6, 0.123456789012, 3.0, 999999.125}) {
    state_exposure(late, 3, value);
    CHECK(exposure(late).turns == 3);
    CHECK(exposure(late).full_scale == doctest::Approx(value).epsilon(1e-8));
    for (const auto& [name, text] : early) CHECK(late.at(name).size() == text.size());
  }
  forget_exposure(late);
  CHECK(late.empty());
}
