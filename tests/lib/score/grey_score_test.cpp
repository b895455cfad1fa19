// SPDX-License-Identifier: GPL-3.0-or-later
#include "score/grey_score.hpp"

#include "base/text/json.hpp"
#include "testing.hpp"

using namespace vam::score;

namespace {

// Two part voxels, errors 0.05 and -0.3; two void voxels, doses 0.08 and 0.5; a void one outside the circle.
const std::vector<float> target{0.5F, 1.0F, 0, 0, 0};
const std::vector<float> dose{0.55F, 0.7F, 0.08F, 0.5F, 9};

GreyScore scored(VoidRule rule, double limit = 0.75) {
  GreyScore score({{0, 0, 3.2}, 0.1, rule, limit}, 5, 1);
  score.add(dose.data(), target.data(), 1);
  return score;
}

}  // namespace

TEST_CASE("a dose in another unit than the target's has the same figures") {
  const std::vector<float> target{0, 0.4F, 1, 1, 0}, dose{0.05F, 0.5F, 1.3F, 0.9F, 0};
  std::vector<float> scaled = dose;
  for (float& one : scaled) one *= 12;
  GreyScore relative({{0, 0, 3.2}, 0.1, VoidRule::met, 0.75}, 5, 1);
  GreyScore absolute({{0, 0, 3.2}, 0.1, VoidRule::met, 0.75, 12}, 5, 1);
  relative.add(dose.data(), target.data(), 1);
  absolute.add(scaled.data(), target.data(), 1);
  for (const std::string& name : GreyScore::names())
    CHECK(absolute.figure(name) == doctest::Approx(relative.figure(name)).epsilon(1e-6));
  CHECK(relative.figure("ipdr") == doctest::Approx(0.3));
}

TEST_CASE("a grey target is met within its band, in part and void") {
  const GreyScore score = scored(VoidRule::met);
  CHECK(score.figure("ver") == doctest::Approx(0.5));  // two of four
  CHECK(score.figure("pw") == doctest::Approx(-0.4));
  CHECK(score.figure("ipdr") == doctest::Approx(0.5));
  CHECK(score.figure("cv") == doctest::Approx(std::sqrt((0.0025 + 0.09 + 0.0064 + 0.25) / 4)));
  CHECK(score.figure("bias") == doctest::Approx(-0.125));
}

TEST_CASE("the void may be left free, or only stay below a dose") {
  CHECK(scored(VoidRule::free).figure("ver") == doctest::Approx(0.5));  // one of two
  CHECK(scored(VoidRule::free).figure("ipdr") == doctest::Approx(0.3));
  CHECK(scored(VoidRule::below).figure("ver") == doctest::Approx(0.25));  // one of four
  CHECK(scored(VoidRule::below, 0.4).figure("ver") == doctest::Approx(0.5));
  CHECK(scored(VoidRule::below, 0.4).figure("pw") == doctest::Approx(-0.2));
}

TEST_CASE("a target of nothing, and a dose that is no number, are refused") {
  GreyScore score({{0, 0, 3.2}, 0.1, VoidRule::met, 0.75}, 5, 1);
  const std::vector<float> nothing(5, 0.0F);
  score.add(dose.data(), nothing.data(), 1);
  CHECK(has(error_of([&] { (void)score.figures(); }, vam::Fault::data), "0 everywhere"));
  const std::vector<float> bad(5, std::nanf(""));
  CHECK(has(error_of([&] { score.add(bad.data(), target.data(), 1); }, vam::Fault::data), "not finite"));
}
