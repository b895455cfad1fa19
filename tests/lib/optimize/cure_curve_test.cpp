// SPDX-License-Identifier: GPL-3.0-or-later
// Response curves in closed form.
#include "optimize/target/cure_curve.hpp"

#include <limits>

#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;

namespace {

constexpr float without_limit = std::numeric_limits<float>::infinity();

doctest::Approx about(double value) { return doctest::Approx(value).epsilon(2e-6); }  // some roundings of float

}  // namespace

TEST_CASE("a table of doses: straight between its points, level beyond them") {
  const CureCurve curve = CureCurve::table({{0.2, 0}, {0.6, 0.1}, {0.9, 0.8}, {1.3, 1}});
  CHECK(curve.response(0.1F) == 0);
  CHECK(curve.response(0.4F) == about(0.05));
  CHECK(curve.response(0.6F) == about(0.1));
  CHECK(curve.response(0.75F) == about(0.45));
  CHECK(curve.response(1.1F) == about(0.9));
  CHECK(curve.response(2) == 1);
  CHECK(curve.slope(0.1F) == 0);
  CHECK(curve.slope(0.2F) == about(0.25));
  CHECK(curve.slope(0.4F) == about(0.25));
  CHECK(curve.slope(0.75F) == about(7.0 / 3));
  CHECK(curve.slope(1.1F) == about(0.5));
  CHECK(curve.slope(1.3F) == 0);
  CHECK(curve.slope(2) == 0);
  CHECK(curve.area(0.1F) == 0);
  CHECK(curve.area(0.6F) == about(0.02));
  CHECK(curve.area(0.75F) == about(0.02 + 0.5 * 0.55 * 0.15));
  CHECK(curve.area(1.3F) == about(0.515));
  CHECK(curve.area(1.5F) == about(0.715));
  CHECK_FALSE(curve.is_step());
  CHECK(fault_of([] { (void)CureCurve::table({{0.2, 0}}); }) == Fault::data);
  CHECK(fault_of([] { (void)CureCurve::table({{0.2, 0}, {0.2, 1}}); }) == Fault::data);
}

TEST_CASE("doses of a response: of level pieces the outermost, without a limit where the curve has none") {
  const CureCurve curve = CureCurve::table({{0.2, 0}, {0.6, 0.1}, {0.9, 0.8}, {1.3, 1}});
  const auto doses = [&](float wanted, float tolerance, double low, double high) {
    CAPTURE(wanted);
    const DoseRange range = curve.doses(wanted, tolerance);
    if (range.low != low) CHECK(static_cast<double>(range.low) == about(low));  // no limit is near no number
    if (range.high != high) CHECK(static_cast<double>(range.high) == about(high));
  };
  doses(0.3F, 0.1F, 0.6 + 0.1 / 0.7 * 0.3, 0.6 + 0.3 / 0.7 * 0.3);
  doses(0, 0.05F, -without_limit, 0.4);
  doses(0, 0, -without_limit, 0.2);
  doses(1, 0.1F, 1.1, without_limit);
  doses(1, 0, 1.3, without_limit);
  doses(2, 0.5F, 1.3, without_limit);    // no dose does it
  doses(-1, 0.5F, -without_limit, 0.2);  // nor this
  const DoseRange level = CureCurve::table({{0, 0}, {1, 0.5}, {2, 0.5}, {3, 1}}).doses(0.5F, 0);
  CHECK(level.low == 1);
  CHECK(level.high == 2);
  const CureCurve step = CureCurve::step(0.7, 0.9);
  CHECK(step.is_step());
  CHECK(step.response(0.85F) == about(0.75));
  CHECK(step.doses(0, 0).high == 0.7F);
  const DoseRange range{0.25F, 0.5F};
  CHECK(range.miss(0.125F) == -0.125F);
  CHECK(range.miss(0.375F) == 0);
  CHECK(range.miss(0.75F) == 0.25F);
}

TEST_CASE("the logistic curve and the straight one") {
  const double softness = 0.05;
  const CureCurve curve = CureCurve::logistic(0.8, softness);
  for (const double x : {-3.0, -1.0, 0.0, 1.0, 4.0}) {
    CAPTURE(x);
    const auto dose = static_cast<float>(0.8 + softness * x);
    const double m = 1 / (1 + std::exp(-x));
    const auto near = [](double value) { return doctest::Approx(value).epsilon(1e-5); };  // the float dose is 1e-7 off
    CHECK(static_cast<double>(curve.response(dose)) == near(m));
    CHECK(static_cast<double>(curve.slope(dose)) == near(m * (1 - m) / softness));
    CHECK(static_cast<double>(curve.area(dose)) == near(softness * std::log1p(std::exp(x))));
  }
  CHECK(curve.area(20) == about(19.2));  // without overflow
  CHECK(curve.area(-20) == 0);
  const DoseRange middle = curve.doses(0.5F, 0.2F);
  CHECK(static_cast<double>(middle.low) == about(0.8 + softness * std::log(0.3 / 0.7)));
  CHECK(static_cast<double>(middle.high) == about(0.8 + softness * std::log(0.7 / 0.3)));
  CHECK(static_cast<double>(curve.doses(1, 0.1F).low) == about(0.8 + softness * std::log(9)));
  CHECK(curve.doses(1, 0.1F).high == without_limit);
  CHECK(curve.doses(0, 0.1F).low == -without_limit);
  CHECK(static_cast<double>(curve.doses(0, 0.1F).high) == about(0.8 - softness * std::log(9)));
  // A response that no dose has is taken as one in a million of the end: ln 1e6 = 13.8; of float's 1 - 1e-6, 13.80.
  CHECK(static_cast<double>(curve.doses(1, 0).low) == doctest::Approx(0.8 + softness * 13.81).epsilon(1e-3));
  CHECK(static_cast<double>(curve.doses(0, 0).high) == doctest::Approx(0.8 - softness * 13.81).epsilon(1e-2));
  const CureCurve line = CureCurve::linear();
  CHECK(line.response(0.3F) == 0.3F);
  CHECK(line.slope(0.3F) == 1);
  CHECK(line.area(0.5F) == 0.125F);
  CHECK(line.doses(0.5F, 0.25F).low == 0.25F);
  CHECK(line.doses(0.5F, 0.25F).high == 0.75F);
}
