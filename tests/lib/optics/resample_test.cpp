// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/resample.hpp"

#include "base/compute/parallel.hpp"
#include "optics/resample_stack.hpp"
#include "optics/writable_radius.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optics;

namespace {

constexpr double turn_rad = 2 * std::numbers::pi;

// [RAY21]'s vial in mm and a projector of any resolution that spans the same field.
const View vial{119.808, 1.0, 0.0, {{12.7, 1.53}}};

struct Sampling {
  Detector virtual_;
  Detector projector;
  Turn turn;
};
Sampling sampling(int fineness) {
  const double pixel_mm = 0.26 / fineness;
  return {centred_detector(80 * fineness + 1, pixel_mm),
          centred_detector(110 * fineness + 1, pixel_mm),
          {180 * fineness, 0, turn_rad / (180 * fineness)}};
}

// Line integrals of a Gaussian blob at (4, 2) mm: smooth, in closed form, not symmetric.
double blob(double t_mm, double theta) {
  const double offset = t_mm - (4 * std::cos(theta) + 2 * std::sin(theta));
  return std::exp(-0.5 * offset * offset / (0.9 * 0.9));
}

Image virtual_blob(const Sampling& s) {
  Image image(s.virtual_.columns, s.turn.rows);
  for (int a = 0; a < image.height; ++a) {
    for (int c = 0; c < image.width; ++c)
      image(c, a) = static_cast<float>(blob(s.virtual_.x_mm(c), a * s.turn.step_rad));
  }
  return image;
}

Image apply(const ResamplePlan& plan, const Image& in) {
  std::vector<Image> out(1);
  resample(plan, {&in, 1}, out);
  return out.front();
}

// RMS error against the definition S_v(x_v, theta + delta) J / T, all columns.
double projector_error(int fineness, Interpolation interpolation) {
  const Sampling s = sampling(fineness);
  ResampleOptions options{.interpolation = interpolation};
  const Image got = apply(plan_to_projector(vial, s.virtual_, s.projector, s.turn, options), virtual_blob(s));
  double sum = 0;
  for (int c = 0; c < got.width; ++c) {
    const ChiefRay ray = chief_ray(vial, s.projector.x_mm(c));
    for (int a = 0; a < got.height; ++a) {
      const double want =
          ray.hits ? blob(ray.x_v_mm, a * s.turn.step_rad + ray.delta_rad) * ray.jacobian / ray.transmittance : 0.0;
      sum += (got(c, a) - want) * (got(c, a) - want);
    }
  }
  return std::sqrt(sum / static_cast<double>(got.size()));
}

double largest_difference(const Image& a, const Image& b) {
  REQUIRE(a.values.size() == b.values.size());
  double most = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    most = std::max(most, static_cast<double>(std::abs(a.values[i] - b.values[i])));
  return most;
}

}  // namespace

TEST_CASE("resampling follows its definition; linear converges with order 2, cubic with order 3 and is better") {
  const double linear = projector_error(1, Interpolation::linear);
  const double cubic = projector_error(1, Interpolation::cubic);
  CHECK(cubic < linear / 4);
  // Halving the pitch: 2^2 and 2^3, less a margin of 15 % for the next order.
  CHECK(linear / projector_error(2, Interpolation::linear) > 0.85 * 4);
  CHECK(cubic / projector_error(2, Interpolation::cubic) > 0.85 * 8);
  CHECK(projector_error(4, Interpolation::cubic) < 1e-5);
}

TEST_CASE("light is conserved: the sum of S_p T over the projector is that of S_v over the virtual one") {
  const Sampling s = sampling(2);
  const Image in = virtual_blob(s);
  const Image out = apply(plan_to_projector(vial, s.virtual_, s.projector, s.turn, {}), in);
  double before = 0;
  double after = 0;
  for (int a = 0; a < s.turn.rows; ++a) {
    for (int c = 0; c < in.width; ++c) {
      if (std::abs(s.virtual_.x_mm(c)) < reach_mm(vial)) before += in(c, a);
    }
    for (int c = 0; c < out.width; ++c) after += out(c, a) * chief_ray(vial, s.projector.x_mm(c)).transmittance;
  }
  // The blob is 2e-5 of its height at the rim of the reach, where the sums are only a Riemann sum.
  CHECK(after == doctest::Approx(before).epsilon(1e-4));
}

TEST_CASE("resampling there and back converges with the order of the cubic") {
  const auto error = [](int fineness) {
    const Sampling s = sampling(fineness);
    const Image in = virtual_blob(s);
    ResampleOptions lossless;  // on its way back to a camera light loses T once more, so T does not cancel
    lossless.fresnel = false;
    const Image there = apply(plan_to_projector(vial, s.virtual_, s.projector, s.turn, lossless), in);
    const Image back = apply(plan_to_virtual(vial, s.projector, s.virtual_, s.turn, lossless), there);
    double most = 0;
    for (int c = 0; c < in.width; ++c) {
      // At the rim the columns end, and the cubic has neighbours on one side only.
      if (std::abs(s.virtual_.x_mm(c)) > 0.95 * reach_mm(vial)) continue;
      for (int a = 0; a < in.height; ++a) most = std::max(most, static_cast<double>(std::abs(in(c, a) - back(c, a))));
    }
    return most;
  };
  const double coarse = error(2);
  CHECK(coarse < 2e-3);
  CHECK(coarse / error(4) > 0.85 * 8);
}

TEST_CASE("a matched telecentric bench changes nothing") {
  const Sampling s = sampling(1);
  const View matched{std::nullopt, 1.53, 20, {{40, 1.53}}};
  ResampleOptions options{.fresnel = false};
  for (const auto interpolation : {Interpolation::linear, Interpolation::cubic}) {
    options.interpolation = interpolation;
    const Image in = virtual_blob(s);
    CHECK(largest_difference(in, apply(plan_to_projector(matched, s.virtual_, s.virtual_, s.turn, options), in)) <
          1e-6);
    CHECK(largest_difference(in, apply(plan_to_virtual(matched, s.virtual_, s.virtual_, s.turn, options), in)) < 1e-6);
  }
}

TEST_CASE("columns that miss the resin or fall outside the sinogram are dark") {
  const Sampling s = sampling(1);
  const Image ones(s.virtual_.columns, s.turn.rows, 1.0F);
  const Image out = apply(plan_to_projector(vial, s.virtual_, s.projector, s.turn, {}), ones);
  for (int c = 0; c < out.width; ++c) CHECK((out(c, 7) > 0) == chief_ray(vial, s.projector.x_mm(c)).hits);
  const Detector narrow = centred_detector(21, s.virtual_.pixel_mm);
  const Image part = apply(plan_to_projector(vial, narrow, s.projector, s.turn, {}), Image(21, s.turn.rows, 1.0F));
  for (int c = 0; c < out.width; ++c) {
    const bool inside = std::abs(chief_ray(vial, s.projector.x_mm(c)).x_v_mm) < 10.5 * narrow.pixel_mm;
    if (!inside) CHECK(part(c, 7) == 0);
  }
}

TEST_CASE("direction and angle offset move the part, not the optics") {
  const Sampling s = sampling(1);
  const Image in = virtual_blob(s);
  const Image plain = apply(plan_to_projector(vial, s.virtual_, s.projector, s.turn, {}), in);
  ResampleOptions options{.angle_offset_rad = 10 * s.turn.step_rad};
  const Image offset = apply(plan_to_projector(vial, s.virtual_, s.projector, s.turn, options), in);
  options.direction = -1;
  const Image reversed = apply(plan_to_projector(vial, s.virtual_, s.projector, s.turn, options), in);
  double most = 0;
  for (const auto [a, c] : indices(s.turn.rows, plain.width)) {
    most = std::max(most, static_cast<double>(std::abs(offset(c, a) - plain(c, (a + 10) % s.turn.rows))));
    most = std::max(most, static_cast<double>(std::abs(reversed(c, a) - plain(c, (190 - a) % s.turn.rows))));
  }
  CHECK(most < 1e-5);  // the fraction of a row, rounded differently
  const Image back = apply(plan_to_virtual(vial, s.projector, s.virtual_, s.turn, options), reversed);
  const Image straight = apply(plan_to_virtual(vial, s.projector, s.virtual_, s.turn, {}), plain);
  CHECK(largest_difference(back, straight) < 1e-5);
}

TEST_CASE("a sinogram whose rows go backwards is the same sinogram") {
  const Sampling s = sampling(1);
  const Image plain = apply(plan_to_projector(vial, s.virtual_, s.projector, s.turn, {}), virtual_blob(s));
  Image mirrored(plain.width, plain.height);
  for (int a = 0; a < plain.height; ++a) {
    std::copy_n(plain.row((plain.height - a) % plain.height), plain.width, mirrored.row(a));
  }
  const Turn backwards{s.turn.rows, 0, -s.turn.step_rad};
  const Image want = apply(plan_to_virtual(vial, s.projector, s.virtual_, s.turn, {}), plain);
  CHECK(largest_difference(want, apply(plan_to_virtual(vial, s.projector, s.virtual_, backwards, {}), mirrored)) <
        1e-5);
}

TEST_CASE("a coarser output averages instead of picking columns") {
  const Sampling s = sampling(4);
  Image stripes(s.projector.columns, s.turn.rows);  // one column light, one dark
  for (std::size_t i = 0; i < stripes.values.size(); ++i) {
    stripes.values[i] = (i % static_cast<std::size_t>(stripes.width)) % 2 == 0 ? 2.0F : 0.0F;
  }
  const Detector coarse = centred_detector(41, 0.26);
  ResampleOptions plain;
  plain.fresnel = plain.jacobian = false;
  const Image out = apply(plan_to_virtual(vial, s.projector, coarse, s.turn, plain), stripes);
  // The stretched kernel spans 6 columns; what is left of the stripes is the tail of its response at half the sampling
  // rate of the input, below 2 %.
  for (int c = 1; c < out.width - 1; ++c) CHECK(std::abs(out(c, 3) - 1) < 0.02);
}

TEST_CASE("overshoot is removed on request") {
  const Sampling s = sampling(1);
  Image edge(s.virtual_.columns, s.turn.rows);
  for (int a = 0; a < edge.height; ++a) std::fill_n(edge.row(a) + 30, 20, 1.0F);
  ResampleOptions options;
  const Image with = apply(plan_to_projector(vial, s.virtual_, s.projector, s.turn, options), edge);
  CHECK(*std::min_element(with.values.begin(), with.values.end()) < -0.01F);
  options.keep_negative = false;
  const Image without = apply(plan_to_projector(vial, s.virtual_, s.projector, s.turn, options), edge);
  CHECK(*std::min_element(without.values.begin(), without.values.end()) == 0.0F);
}

TEST_CASE("slices do not depend on their neighbours or on the number of threads") {
  const Sampling s = sampling(1);
  const ResamplePlan plan = plan_to_projector(vial, s.virtual_, s.projector, s.turn, {});
  std::vector<Image> in(19, virtual_blob(s));
  for (std::size_t k = 0; k < in.size(); ++k) {
    for (float& value : in[k].values) value *= static_cast<float>(k + 1);
  }
  std::vector<Image> all(in.size());
  resample(plan, in, all);
  set_threads(1);
  std::vector<Image> one(in.size());
  resample(plan, in, one);
  set_threads(0);
  for (std::size_t k = 0; k < in.size(); ++k) {
    CHECK(all[k].values == one[k].values);
    CHECK(all[k].values == apply(plan, in[k]).values);
  }
}

TEST_CASE("half a turn and mixed shapes are refused") {
  Sampling s = sampling(1);
  const ResamplePlan plan = plan_to_projector(vial, s.virtual_, s.projector, s.turn, {});
  CHECK_THROWS_AS(apply(plan, Image(3, s.turn.rows)), Error);
  s.turn.step_rad /= 2;
  CHECK_THROWS_AS(static_cast<void>(plan_to_projector(vial, s.virtual_, s.projector, s.turn, {})), Error);
}

TEST_CASE("a stack without a column pitch is refused") {
  model::StackInfo info{.width = 64, .height = 36, .count = 1, .row_mm = 0.1, .angle_step_deg = 10};
  for (const double pitch : {0.0, -0.1, std::nan("")}) {
    info.pixel_mm = pitch;
    CHECK_THROWS_WITH_AS((void)stack_to_projector(model::Printer(), {}, info, {}),
                         doctest::Contains("its column pitch is"), Error);
  }
}
