// SPDX-License-Identifier: GPL-3.0-or-later
#include "score/score.hpp"

#include "base/text/json.hpp"
#include "testing.hpp"

using vam::score::Score;
using vam::score::ScoreOptions;

namespace {

// 3 x 3 slices around an axis at (1, 1); a radius of 1 leaves the four corners out.
const std::vector<float> target{0, 0, 0, 0, 1, 0.5F, 0, 1, 0};
const std::vector<float> dose{9, 0.2F, 9, 0.1F, 0.8F, 0.7F, 9, 1.0F, 9};

ScoreOptions options() { return {.circle = {1, 1, 1}}; }

}  // namespace

TEST_CASE("void outside the writable circle and surface voxels are not judged") {
  Score score(options(), 3, 3);
  score.add(dose.data(), target.data(), 1);
  const auto json = score.figures();
  CHECK(json["part_voxels"] == 2);
  CHECK(json["void_voxels"] == 2);
  CHECK(json["surface_voxels"] == 1);
  CHECK(score.figure("pw") == doctest::Approx(0.6));
  CHECK(score.figure("ver") == 0.0);
  CHECK(std::isnan(score.figure("cured_iou")));
}

TEST_CASE("surface voxels count on request, from half coverage on") {
  auto o = options();
  o.surface = true;
  Score score(o, 3, 3);
  score.add(dose.data(), target.data(), 1);
  CHECK(score.figure("min_part") == doctest::Approx(0.7));
}

TEST_CASE("absolute figures keep the dose's unit, and the critical dose is judged") {
  auto o = options();
  o.absolute = true;
  o.threshold = 90;
  Score score(o, 3, 3);
  std::vector<float> hundredfold = dose;
  for (float& d : hundredfold) d *= 100;
  score.add(hundredfold.data(), target.data(), 1);
  CHECK(score.figure("pw") == doctest::Approx(60));
  CHECK(score.figure("cured_part") == doctest::Approx(0.5));
  CHECK(score.figure("cured_void") == 0.0);
  CHECK(score.figure("cured_wrong") == doctest::Approx(0.25));
  CHECK(has(score.table(), "cured_wrong"));
}

TEST_CASE("a dose without light has no exposure: its figures are unknown, and there is no verdict") {
  auto o = options();
  o.exposure = vam::score::Exposure{};
  o.exposure->printer.resin.critical_dose_mj_cm3 = 90;
  Score dark(o, 3, 3);
  const std::vector<float> nothing(9, 0.0F);
  dark.add(nothing.data(), target.data(), 1);
  for (const char* name : {"turns", "seconds", "multiplier", "peak_intensity_mw_cm2"})
    CHECK(std::isnan(dark.figure(name)));
  CHECK_THROWS_WITH_AS((void)dark.figures(), doctest::Contains("0 everywhere"), vam::Error);
  Score lit(o, 3, 3);
  lit.add(dose.data(), target.data(), 1);
  // Doses of a turn: part 0.8 and 1, void 0.1 and 0.2; 90 / (middle 0.5 + quarter 0.15) = 138.5 turns.
  CHECK(lit.figure("turns") == 139);
  CHECK(lit.figure("multiplier") == doctest::Approx(1.0));
}

TEST_CASE(
    "for the dose of one turn the print is that of the planned exposure, for the dose of a print that of the dose") {
  auto o = options();
  o.exposure = vam::score::Exposure{};
  o.exposure->printer.resin.critical_dose_mj_cm3 = 0.08;  // a turn at full intensity would cure the void as well
  Score turn(o, 3, 3);
  turn.add(dose.data(), target.data(), 1);
  // One turn at the multiplier that brings the middle of the window, 0.5, to 0.08.
  CHECK(turn.figure("turns") == 1);
  CHECK(turn.figure("multiplier") == doctest::Approx(0.16));
  CHECK(turn.print_threshold() == doctest::Approx(0.5));
  CHECK(turn.figure("cured_part") == 1);
  CHECK(turn.figure("cured_void") == 0);
  CHECK(turn.figure("cured_wrong") == 0);
  o.exposure->printer.resin.critical_dose_mj_cm3 = 90;  // a turn cures nothing; 139 of them in full light do
  Score faint(o, 3, 3);
  faint.add(dose.data(), target.data(), 1);
  CHECK(faint.print_threshold() == doctest::Approx(90.0 / 139));
  CHECK(faint.figure("cured_part") == 1);
  CHECK(faint.figure("cured_void") == 0);
  o.exposure->full_intensity_turns = 1;  // that was all
  o.threshold = 90;
  Score whole(o, 3, 3);
  whole.add(dose.data(), target.data(), 1);
  CHECK(whole.print_threshold() == 90);
  CHECK(whole.figure("cured_part") == 0);
}

TEST_CASE("empty parts and non-finite doses are errors") {
  Score empty(options(), 3, 3);
  const std::vector<float> nothing(9, 0.0F);
  empty.add(dose.data(), nothing.data(), 1);
  CHECK_THROWS_WITH_AS((void)empty.figures(),
                       doctest::Contains("target: no voxel of it is wholly inside the part; slice"), vam::Error);
  ScoreOptions named = options();
  named.target = "part.vdb";
  Score full(named, 3, 3);
  const std::vector<float> everything(9, 1.0F);
  full.add(dose.data(), everything.data(), 1);
  CHECK_THROWS_WITH_AS((void)full.figures(),
                       doctest::Contains("part.vdb: no voxel of it is void inside the writable circle"), vam::Error);
  Score broken(options(), 3, 3);
  auto bad = dose;
  bad[4] = std::nanf("");
  CHECK_THROWS_WITH_AS(broken.add(bad.data(), target.data(), 1), doctest::Contains("not finite everywhere"),
                       vam::Error);
}
