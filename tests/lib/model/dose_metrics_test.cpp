// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/dose/dose_metrics.hpp"

#include "model/conditions.hpp"
#include "model/dose/figures.hpp"
#include "testing.hpp"

using namespace vam::model;

namespace {

struct Sample {
  std::vector<double> part, void_;
};

Sample overlapping(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> high(0.8F, 0.1F);
  std::normal_distribution<float> low(0.4F, 0.15F);
  Sample sample;
  for (int i = 0; i < 2000; ++i) sample.part.push_back(static_cast<double>(std::max(0.0F, high(random))));
  for (int i = 0; i < 6000; ++i) sample.void_.push_back(static_cast<double>(std::max(0.0F, low(random))));
  return sample;
}

DoseStatistics gathered(const Sample& sample, std::optional<double> threshold = std::nullopt) {
  DoseStatistics statistics(threshold);
  for (const double v : sample.part) statistics.add(static_cast<float>(v), Label::part);
  for (const double v : sample.void_) statistics.add(static_cast<float>(v), Label::void_);
  statistics.add(5.0F, Label::surface);  // counts for nothing
  statistics.add(9.0F, Label::outside);
  return statistics;
}

double iou_at(const Sample& s, double threshold) {
  const auto above = [&](const std::vector<double>& v) {
    return static_cast<double>(std::count_if(v.begin(), v.end(), [&](double x) { return x >= threshold; }));
  };
  return above(s.part) / (static_cast<double>(s.part.size()) + above(s.void_));
}

}  // namespace

TEST_CASE("figures of an overlapping dose against their definitions") {
  const Sample sample = overlapping(1);
  const auto m = gathered(sample).metrics();
  const double least = *std::min_element(sample.part.begin(), sample.part.end());
  const double most = *std::max_element(sample.part.begin(), sample.part.end());
  const double most_void = *std::max_element(sample.void_.begin(), sample.void_.end());
  const double top = std::max(most, most_void);
  CHECK(m.pw == doctest::Approx((least - most_void) / top));
  CHECK(m.latitude == doctest::Approx(2 * (least - most_void) / (least + most_void)));
  CHECK(m.ipdr == doctest::Approx((most - least) / top));
  const auto wrong = std::count_if(sample.void_.begin(), sample.void_.end(), [&](double v) { return v >= least; });
  CHECK(m.ver == doctest::Approx(static_cast<double>(wrong) / 8000).epsilon(0.01));  // bins of 2^-12
  double mean = 0;
  for (const double v : sample.part) mean += v / 2000;
  double variance = 0;
  for (const double v : sample.part) variance += (v - mean) * (v - mean) / 2000;
  CHECK(m.cv == doctest::Approx(std::sqrt(variance) / mean));
  double best = 0;
  for (const double v : sample.part) best = std::max(best, iou_at(sample, v));  // the best threshold is a part dose
  CHECK(m.iou == doctest::Approx(best).epsilon(1e-3));
  CHECK(iou_at(sample, m.iou_threshold) == doctest::Approx(best).epsilon(1e-3));
}

TEST_CASE("a dose that separates the two prints the part exactly") {
  const auto m = gathered({{1.0, 0.9, 0.8}, {0.1, 0.2, 0.6}}).metrics();
  CHECK(m.pw == doctest::Approx(0.2));
  CHECK(m.ver == 0.0);
  CHECK(m.iou == 1.0);
  CHECK(m.iou_threshold == doctest::Approx(0.7));
}

TEST_CASE("trimming leaves out the extremes") {
  Sample sample{std::vector<double>(1000, 0.9), std::vector<double>(1000, 0.3)};
  sample.part[0] = 0.1;
  sample.void_[0] = 0.95;
  CHECK(gathered(sample).metrics().pw < 0);
  const auto m = gathered(sample).trimmed(0.01);
  CHECK(m.min_part == doctest::Approx(0.9).epsilon(DoseHistogram::resolution));
  CHECK(m.max_void == doctest::Approx(0.3).epsilon(DoseHistogram::resolution));
  CHECK(m.ver == doctest::Approx(1.0 / 2000));  // the one void voxel that is cured with the part
}

TEST_CASE("a print at a given threshold is counted exactly") {
  const Sample sample = overlapping(2);
  const auto at = *gathered(sample, 0.61).at_threshold();
  CHECK(at.iou == doctest::Approx(iou_at(sample, 0.61)).epsilon(1e-12));
  CHECK(!gathered(sample).at_threshold());
}

TEST_CASE("merging adds, also repeatedly") {
  const Sample a = overlapping(3);
  const Sample b = overlapping(4);
  DoseStatistics merged = gathered(a);
  merged.merge(gathered(b), 2);
  Sample all = a;
  for (int twice = 0; twice < 2; ++twice) {
    all.part.insert(all.part.end(), b.part.begin(), b.part.end());
    all.void_.insert(all.void_.end(), b.void_.begin(), b.void_.end());
  }
  const auto m = merged.metrics();
  const auto want = gathered(all).metrics();
  CHECK(m.ver == want.ver);
  CHECK(m.iou == want.iou);
  CHECK(m.pw == want.pw);
  CHECK(m.cv == doctest::Approx(want.cv));
}

TEST_CASE("doses of any unit and zero are binned") {
  DoseHistogram histogram;
  for (const float v : {0.0F, 1e-30F, 1e-5F, 3.0F, 3e5F, 1e20F}) histogram.add(v);
  CHECK(histogram.total() == 6);
  CHECK(histogram.count_from(3.0) == 3);
  CHECK(histogram.quantile(0) == 0.0);
  CHECK(histogram.quantile(0.6) == doctest::Approx(3.0).epsilon(DoseHistogram::resolution));
}

TEST_CASE("light efficiency is mean over maximum") {
  LightEfficiency efficiency;
  CHECK(efficiency.value() == 0.0);
  efficiency.add(std::vector<float>{0, 1, 2, 4, 3});
  CHECK(efficiency.value() == doctest::Approx(0.5));
}

TEST_CASE("conditions") {
  const std::vector<std::string> known{"ver", "pw"};
  const auto conditions = parse_conditions(" ver <= 0.01, pw>=-1e-2 ", known);
  REQUIRE(conditions.size() == 2);
  const auto value = [](const std::string& name) { return name == "ver" ? 0.02 : 0.0; };
  const auto lines = unmet(conditions, value);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0] == "ver = 0.02, but ver<=0.01 is required");
  CHECK_THROWS_WITH_AS(parse_conditions("vre<=1", known), doctest::Contains("expected one of ver, pw"), vam::Error);
  CHECK(parse_conditions("ver<=0.5 %", known, {"ver"})[0].bound == 0.5);
  CHECK_THROWS_AS(parse_conditions("ver<=0.5%", known), vam::Error);  // a fraction is not in per cent
  CHECK_THROWS_WITH_AS(parse_conditions("ver<=", known), doctest::Contains("'' is not a number"), vam::Error);
  CHECK_THROWS_WITH_AS(parse_conditions("ver", known), doctest::Contains("no relation"), vam::Error);
  CHECK_THROWS_WITH_AS(parse_conditions("ver<=1,", known), doctest::Contains("empty condition"), vam::Error);
  CHECK_THROWS_WITH_AS(parse_conditions("ver<=nan", known), doctest::Contains("not a number"), vam::Error);
  CHECK(!holds({"ver", "<", 1}, 1));
  CHECK(!holds({"ver", ">=", 1}, std::nan("")));
}

TEST_CASE("a figure of merit is found by its name, any other is none") {
  DoseMetrics metrics{.ver = 0.25, .pw = -0.5};
  CHECK(figure(metrics, "ver") == 0.25);
  CHECK(figure(metrics, "pw") == -0.5);
  CHECK(std::isnan(figure(metrics, "no figure")));
}

TEST_CASE("part and void within one bin are separated by their extremes") {
  const float low = 1.0001F;
  const float high = 1.0002F;  // a bin reaches from 1 to 1 + 2^-12
  const auto m = gathered({{high, 2}, {low, 0.5}}).metrics();
  CHECK(m.ver == 0);
  CHECK(m.iou == 1);
  CHECK(m.iou_threshold == doctest::Approx(1.00015).epsilon(1e-6));
}
