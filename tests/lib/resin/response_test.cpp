// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/response.hpp"

#include "testing.hpp"

using vam::resin::GreyLevels;
using vam::resin::Response;

namespace {

// A display's gamma curve, sampled as a calibration would: 17 levels of 8 bits.
vam::model::ResponseTable gamma_table(double gamma) {
  vam::model::ResponseTable table{"gamma", {}, {}};
  for (int grey = 0; grey <= 255; grey += 15) {
    table.grey.push_back(grey);
    table.intensity.push_back(3.8 * std::pow(grey / 255.0, gamma));
  }
  return table;
}

}  // namespace

TEST_CASE("a monotone cubic through 18 points of a gamma curve follows it and rises everywhere") {
  const Response response(gamma_table(2.2));
  double before = -1;
  for (int i = 0; i <= 1000; ++i) {
    const double g = i / 1000.0;
    // Third-order interpolation error h^3 |f'''| / 8 = (1/17)^3 * 0.6 / 8 ~ 2e-5, larger next to 0 where f''' diverges.
    CHECK(response.intensity(g) == doctest::Approx(std::pow(g, 2.2)).epsilon(1e-3).scale(1));
    CHECK(response.intensity(g) >= before);
    before = response.intensity(g);
  }
}

TEST_CASE("grey undoes intensity") {
  const Response response(gamma_table(2.2));
  for (int i = 0; i <= 1000; ++i) CHECK(response.grey(response.intensity(i / 1000.0)) == doctest::Approx(i / 1000.0));
}

TEST_CASE("a straight table gives straight lines, and a dark level is the lowest intensity") {
  const Response response(0.1);
  CHECK(response.intensity(0) == 0.1);
  CHECK(response.intensity(0.5) == doctest::Approx(0.55));
  CHECK(response.grey(0.05) == 0);
  CHECK(response.grey(0.55) == doctest::Approx(0.5));
}

TEST_CASE("a saturated end answers with its lowest grey") {
  const Response response(vam::model::ResponseTable{"t", {0, 100, 200, 255}, {0, 3, 6, 6}});
  CHECK(response.grey(1.0) == doctest::Approx(200.0 / 255));
  CHECK(response.intensity(1.0) == 1);
}

TEST_CASE("tables that fall, or do not rise in grey, are data errors") {
  const auto fault_of = [](const std::vector<double>& grey, const std::vector<double>& intensity) {
    return ::fault_of([&] { Response{vam::model::ResponseTable{"t.csv", grey, intensity}}; });
  };
  CHECK(fault_of({0, 1, 2}, {0, 2, 1}) == vam::Fault::data);
  CHECK(fault_of({0, 2, 2}, {0, 1, 2}) == vam::Fault::data);
  CHECK(fault_of({1, 2, 3}, {0, 1, 2}) == vam::Fault::data);
  CHECK(fault_of({0, 1, 2}, {0, 0, 0}) == vam::Fault::data);
  CHECK(fault_of({0, 1, 2}, {0, 1, NAN}) == vam::Fault::data);
}

TEST_CASE("levels are nearest in intensity, by brute force over every level") {
  const Response response(gamma_table(2.2));
  for (const int bits : {1, 2, 4, 8, 10}) {
    const GreyLevels levels(response, bits);
    REQUIRE(levels.count() == 1 << bits);
    for (int i = -5; i <= 105; ++i) {
      const float wanted = static_cast<float>(i) / 100;
      int best = 0;
      for (int level = 1; level < levels.count(); ++level) {
        if (std::abs(levels.intensity(level) - wanted) < std::abs(levels.intensity(best) - wanted)) best = level;
      }
      CHECK(std::abs(levels.intensity(levels.level(wanted)) - wanted) ==
            doctest::Approx(std::abs(levels.intensity(best) - wanted)).epsilon(1e-6));
    }
  }
}

TEST_CASE("the level changes at the float at which the next one becomes nearer, also along flat parts") {
  for (const Response& response : {Response(), Response(0.1), Response(gamma_table(2.2)),
                                   Response({"flat", {0, 1, 2, 3, 4}, {0.1, 0.1, 0.5, 0.5, 0.5}})}) {
    for (const int bits : {1, 3, 8}) {
      const GreyLevels levels(response, bits);
      const auto miss = [&](int level, float wanted) { return std::abs(levels.intensity(level) - wanted); };
      for (int level = 0; level + 1 < levels.count(); ++level) {
        const float middle = (levels.intensity(level) + levels.intensity(level + 1)) / 2;
        for (const float wanted : {std::nextafter(middle, 0.0F), middle, std::nextafter(middle, 2.0F)}) {
          const int got = levels.level(wanted);
          CHECK(miss(got, wanted) <= std::min(miss(level, wanted), miss(level + 1, wanted)));
          const bool lowest = got == 0 || levels.intensity(got - 1) < levels.intensity(got);
          CHECK(lowest);
        }
      }
    }
  }
}

TEST_CASE("every level maps to itself") {
  const GreyLevels levels(Response(), 8);
  for (int level = 0; level < 256; ++level) CHECK(levels.level(levels.intensity(level)) == level);
}

TEST_CASE("images of levels and of intensity are each other's inverse; above full is full") {
  const GreyLevels levels(Response(gamma_table(2.2)), 4);
  vam::Image light(3, 1);
  light.values = {levels.intensity(3), 7.0F, -1.0F};
  vam::GreyImage image;
  to_levels(light, levels, image);
  CHECK(image.bits == 4);
  CHECK(image.values == std::vector<std::uint16_t>{3, 15, 0});
  CHECK(to_intensity(image, levels).values == std::vector<float>{levels.intensity(3), 1.0F, 0.0F});
}

TEST_CASE("intensities above full are clipped and counted") {
  vam::Image light(2, 2);
  light.values = {0, 1, 2, 4};
  const auto tally = vam::resin::limit_to_full(light, 0.5F);
  CHECK(light.values == std::vector<float>{0, 0.5F, 1, 1});
  CHECK(tally.pixels == 4);
  CHECK(tally.lit == 3);
  CHECK(tally.clipped == 1);
  CHECK(tally.light == 2.5);
}
