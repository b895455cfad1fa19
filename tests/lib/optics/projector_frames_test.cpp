// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/projector_frames.hpp"

#include "optics/flatland_movie.hpp"
#include "optics/private/sample_taps.hpp"
#include "testing.hpp"

using namespace vam::optics;
using vam::Image;
using vam::model::StackInfo;

namespace {

StackInfo sinograms(int width, int angles, int count, double pixel_mm, double row_mm, double z_start_mm) {
  return {.space = vam::model::Space::projector,
          .width = width,
          .height = angles,
          .count = count,
          .pixel_mm = pixel_mm,
          .row_mm = row_mm,
          .z_start_mm = z_start_mm,
          .angle_step_deg = 360.0 / angles};
}

// A value that tells slice, angle and column apart; dark in the outer two columns.
Image labelled(const StackInfo& info, int slice) {
  Image image(info.width, info.height);
  for (int a = 0; a < info.height; ++a) {
    for (int c = 2; c < info.width - 2; ++c) image(c, a) = static_cast<float>(1 + c + 100 * a + 10000 * slice);
  }
  return image;
}

FrameComposer composed(const StackInfo& info, const FramePlace& place) {
  FrameComposer composer("part.exr", info, place);
  for (int k = 0; k < info.count; ++k) composer.add(labelled(info, k), info.z_start_mm + k * info.row_mm);
  composer.check();
  return composer;
}

}  // namespace

TEST_CASE("taps: on the grid one, between linear, wider the mean; always 1 in sum and centred") {
  CHECK(sample_taps(3, 1).weights == std::vector<float>{1});
  CHECK(sample_taps(3.25, 0.5).weights == std::vector<float>{0.75F, 0.25F});
  CHECK(sample_taps(2, 2).weights == std::vector<float>{0.25F, 0.5F, 0.25F});
  CHECK(sample_taps(-0.5, 2).first == -1);
  for (double width = 0.3; width < 5; width += 0.37) {
    for (double position = -3; position < 3; position += 0.21) {
      const Taps taps = sample_taps(position, width);
      double sum = 0;
      double centre = 0;
      for (std::size_t k = 0; k < taps.weights.size(); ++k) {
        CHECK(taps.weights[k] > 0);
        sum += static_cast<double>(taps.weights[k]);
        centre += static_cast<double>(taps.weights[k]) * (taps.first + static_cast<int>(k));
      }
      CHECK(sum == doctest::Approx(1));
      // The mean over cells sees a ramp as stairs: off by at most a quarter step over the width, at each end.
      CHECK(std::abs(centre - position) <= (width > 1 ? 0.25 / width : 1e-6));
    }
  }
}

TEST_CASE("a schedule has one frame per time step and starts at angle 0") {
  const FrameSchedule schedule = frame_schedule(16, 10, 2);
  CHECK(schedule.count == 1152);
  CHECK(schedule.angle_deg(576) == doctest::Approx(360));
  CHECK(schedule.time_s(16) == doctest::Approx(1));
  error_of([] { (void)frame_schedule(1, 200, 1); }, vam::Fault::usage);
  error_of([] { (void)frame_schedule(16, 1e-9, 1); }, vam::Fault::usage);
}

TEST_CASE("at matching pitch a frame is the transpose: row = slice from the top, exact") {
  const StackInfo info = sinograms(20, 12, 5, 0.1, 0.1, -0.2);
  const FrameComposer composer = composed(info, {20, 9, 0.1, 4.0, 0});
  for (const int angle : {0, 3, 11}) {
    const Image frame = composer.frame(angle * 30.0 + 360, 30);
    for (const auto [r, c] : indices(9, 20)) {
      const int slice = 6 - r;  // z = 0 is slice 2 and row 4
      CHECK(frame(c, r) == (slice >= 0 && slice < 5 ? labelled(info, slice)(c, angle) : 0));
    }
  }
}

TEST_CASE("between angles a frame is interpolated, also across 360 degrees; a negative step is followed backwards") {
  StackInfo info = sinograms(20, 12, 1, 0.1, 0.1, 0);
  const Image half = composed(info, {20, 1, 0.1, 0, 0}).frame(345, 10);
  const float last = labelled(info, 0)(7, 11);
  const float first = labelled(info, 0)(7, 0);
  CHECK(half(7, 0) == doctest::Approx(0.5F * (last + first)));
  info.angle_step_deg = -30;
  CHECK(composed(info, {20, 1, 0.1, 0, 0}).frame(30, 30)(7, 0) == last);
}

TEST_CASE("a frame that spans several angles is their mean, so a turn of frames delivers all the light") {
  const StackInfo info = sinograms(20, 12, 1, 0.1, 0.1, 0);
  const FrameComposer composer = composed(info, {20, 1, 0.1, 0, 0});
  double shown = 0;
  for (int n = 0; n < 5; ++n) shown += static_cast<double>(composer.frame(n * 72.0, 72)(7, 0)) * 72;
  double wanted = 0;
  for (int a = 0; a < 12; ++a) wanted += static_cast<double>(labelled(info, 0)(7, a)) * 30;
  CHECK(shown == doctest::Approx(wanted));
}

TEST_CASE("what is lit holds all light of every frame, and is composed as in the whole frame") {
  for (const double pitch_mm : {0.03, 0.1, 0.35, 0.8}) {
    for (const double axis_row : {12.0, 14.3}) {
      CAPTURE(pitch_mm);
      const StackInfo info = sinograms(20, 12, 3, 0.1, pitch_mm, -pitch_mm);
      FrameComposer composer("part.exr", info, {20, 26, 0.1, axis_row, 0.25});
      for (int k = 0; k < 3; ++k)
        composer.add(k == 1 ? labelled(info, k) : Image(20, 12), info.z_start_mm + k * pitch_mm);
      const vam::PixelRect lit = composer.lit();
      CHECK(lit.width == 17);  // 16 and one for the quarter column
      for (const double angle_deg : {0.0, 100.0}) {
        Image whole = composer.frame(angle_deg, 45);
        const Image part = composer.frame(angle_deg, 45, lit, Image(3, 3, 7));
        for (int y = 0; y < lit.height; ++y) {
          CHECK(std::equal(part.row(y), part.row(y) + lit.width, whole.row(lit.top + y) + lit.left));
          std::fill_n(whole.row(lit.top + y) + lit.left, lit.width, 0.0F);
        }
        CHECK(std::all_of(whole.values.begin(), whole.values.end(), [](float value) { return value == 0; }));
      }
    }
  }
}

TEST_CASE("a part of an image is where its pixels are when it is turned") {
  Image image(7, 5);
  image(2, 1) = image(3, 1) = 1;
  for (const std::string how : {"normal", "flip-columns", "flip-rows", "rotate-180"}) {
    Image turned = image;
    orient(turned, how);
    const vam::PixelRect part = vam::optics::oriented({2, 1, 2, 1}, 7, 5, how);
    CHECK(turned(part.left, part.top) == 1);
    CHECK(turned(part.left + 1, part.top) == 1);
  }
}

TEST_CASE("a row shows the mean over its height of finer, equal or coarser slices, which is all their light") {
  const StackInfo fine = sinograms(20, 4, 8, 0.2, 0.1, -0.35);  // 0.8 mm on rows of 0.2 mm
  const Image frame = composed(fine, {20, 4, 0.2, 1.5, 0}).frame(0, 90);
  for (int r = 0; r < 4; ++r) {
    const float mean = 0.5F * (labelled(fine, 7 - 2 * r)(5, 0) + labelled(fine, 6 - 2 * r)(5, 0));
    CHECK(frame(5, r) == doctest::Approx(mean));
  }
  const StackInfo coarse = sinograms(20, 4, 2, 0.1, 0.2, -0.1);  // slices at -0.1 and 0.1 mm, rows of 0.1 mm
  const Image tall = composed(coarse, {20, 5, 0.1, 2, 0}).frame(0, 90);
  const float low = labelled(coarse, 0)(5, 0);
  const float high = labelled(coarse, 1)(5, 0);
  CHECK(tall(5, 1) == high);
  CHECK(tall(5, 2) == doctest::Approx(0.5F * (low + high)));
  CHECK(tall(5, 3) == low);
  CHECK(tall(5, 4) == doctest::Approx(0.5F * low));                         // half of the row is beyond the slices
  const Image twice = composed(coarse, {20, 4, 0.1, 1.5, 0}).frame(0, 90);  // two rows a slice: as they are
  for (int r = 0; r < 4; ++r) CHECK(twice(5, r) == (r < 2 ? high : low));
  for (const double pitch_mm : {0.03, 0.1, 0.14, 0.37}) {
    const StackInfo info = sinograms(20, 4, 3, 0.1, pitch_mm, -pitch_mm + 0.013);
    const Image frame_of_any = composed(info, {20, 16, 0.1, 7.5, 0}).frame(0, 90);
    double shown = 0, wanted = 0;
    for (int r = 0; r < 16; ++r) shown += 0.1 * static_cast<double>(frame_of_any(5, r));
    for (int k = 0; k < 3; ++k) wanted += pitch_mm * static_cast<double>(labelled(info, k)(5, 0));
    CHECK(shown == doctest::Approx(wanted).epsilon(1e-6));
  }
}

TEST_CASE("how far slices of whole rows lie beside the rows") {
  const FramePlace place{20, 9, 0.1, 4.0, 0};
  const auto beside = [&](int count, double row_mm, double z_start_mm) {
    return beside_rows(sinograms(20, 12, count, 0.1, row_mm, z_start_mm), place);
  };
  CHECK(beside(5, 0.1, -0.2) == doctest::Approx(0));
  CHECK(beside(4, 0.1, -0.15) == doctest::Approx(0.5));
  CHECK(beside(3, 0.2, -0.15) == doctest::Approx(0));
  CHECK(beside(3, 0.2, -0.22) == doctest::Approx(0.3));
  CHECK(beside(3, 0.15, -0.22) == 0);  // not whole rows
  CHECK(beside(3, 0.05, -0.22) == 0);
  CHECK(beside(1, 0.1, -0.22) == 0);
}

TEST_CASE("the column offset moves the light by fractions of a pixel") {
  const StackInfo info = sinograms(20, 4, 1, 0.1, 0.1, 0);
  const Image plain = composed(info, {20, 1, 0.1, 0, 0}).frame(0, 90);
  const Image moved = composed(info, {20, 1, 0.1, 0, 1.25}).frame(0, 90);
  for (int c = 2; c < 20; ++c) CHECK(moved(c, 0) == doctest::Approx(0.75F * plain(c - 1, 0) + 0.25F * plain(c - 2, 0)));
  CHECK(moved(1, 0) == 0);
}

TEST_CASE("rejects out-of-range, negative, missing or mismatched intensity") {
  const StackInfo info = sinograms(20, 4, 5, 0.1, 0.1, -0.2);
  CHECK(has(error_of(
                [&] {
                  (void)composed(info, {20, 4, 0.1, 1.5, 0});
                },
                vam::Fault::data),
            "rows -0.5 to 3.5, but the projector has rows 0 to 3"));
  CHECK(has(error_of(
                [&] {
                  (void)composed(info, {20, 9, 0.1, 4, 3});
                },
                vam::Fault::data),
            "columns 5 to 20, but the projector has columns 0 to 19"));
  CHECK(has(error_of(
                [&] {
                  (void)composed(info, {24, 9, 0.1, 4, 0});
                },
                vam::Fault::data),
            "20 columns, but the projector has 24"));
  CHECK(has(error_of(
                [&] {
                  (void)composed(info, {20, 9, 0.2, 4, 0});
                },
                vam::Fault::data),
            "0.1 mm, but the projector's are 0.2 mm"));
  StackInfo half_turn = info;
  half_turn.angle_step_deg = 45;
  CHECK(has(error_of([&] { (void)composed(half_turn, {20, 9, 0.1, 4, 0}); }, vam::Fault::data), "span 180 degrees"));
  FrameComposer composer("part.exr", info, {20, 9, 0.1, 4, 0});
  Image image(20, 4);
  composer.add(image, 0);
  CHECK(has(error_of([&] { composer.check(); }, vam::Fault::data), "all dark"));
  image(3, 2) = -0.5F;
  CHECK(has(error_of([&] { composer.add(image, 0.1); }, vam::Fault::data), "-0.5"));
}

TEST_CASE("orientation flips rows and columns as named, and the stack's z follows") {
  Image image(3, 2);
  image.values = {1, 2, 3, 4, 5, 6};
  const auto turned = [&](const std::string& orientation) {
    Image copy = image;
    orient(copy, orientation);
    return copy.values;
  };
  CHECK(turned("normal") == image.values);
  CHECK(turned("flip-columns") == std::vector<float>{3, 2, 1, 6, 5, 4});
  CHECK(turned("flip-rows") == std::vector<float>{4, 5, 6, 1, 2, 3});
  CHECK(turned("rotate-180") == std::vector<float>{6, 5, 4, 3, 2, 1});
  const FramePlace place{3, 2, 0.1, 0.5, 0};
  const StackInfo upright = frames_info(sinograms(3, 4, 1, 0.1, 0.1, 0), place, frame_schedule(16, 10, 1), "normal");
  CHECK(upright.z_start_mm == doctest::Approx(0.05));
  CHECK(upright.row_mm == doctest::Approx(-0.1));
  const StackInfo flipped = frames_info(sinograms(3, 4, 1, 0.1, 0.1, 0), place, frame_schedule(16, 10, 1), "flip-rows");
  CHECK(flipped.z_start_mm == doctest::Approx(-0.05));
  CHECK(flipped.row_mm == doctest::Approx(0.1));
}

TEST_CASE("flatland: the frames of a turn add up to the dose in closed form") {
  // Every angle projects the same Gaussian of width s: D(r) = integral of exp(-(r cos)^2 / 2 s^2) dtheta = 2 pi e^-q
  // I0(q), q = r^2 / 4 s^2.
  const double s_mm = 1.5;
  const int columns = 201;
  const double detector_mm = 0.1;
  std::vector<float> projection;
  for (int c = 0; c < columns; ++c) {
    const double t = (c - 100) * detector_mm;
    projection.push_back(static_cast<float>(std::exp(-t * t / (2 * s_mm * s_mm))));
  }
  const ImagePlane canvas{61, 41, 0.2, 28, 22.5};
  const int frames = 360;
  std::vector<double> sum(61 * 41, 0.0);
  for (int n = 0; n < frames; ++n) {
    const Image frame = smear(projection, detector_mm, n * 2 * std::numbers::pi / frames, canvas);
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += static_cast<double>(frame.values[i]) * 2 * std::numbers::pi / frames;
  }
  for (const auto [y, x] : indices(41, 61)) {
    const double r_mm = 0.2 * std::hypot(x - 28, y - 22.5);
    const double q = r_mm * r_mm / (4 * s_mm * s_mm);
    const double dose = 2 * std::numbers::pi * std::exp(-q) * std::cyl_bessel_i(0.0, q);
    CHECK(std::abs(sum[y * 61 + x] - dose) / (2 * std::numbers::pi) <
          1e-3);  // linear interpolation errs by h^2 / 8 s^2 = 5.6e-4 at the crest
  }
}

TEST_CASE("flatland: the frames of a made-up sinogram add up to a plain back-projection, right way up") {
  const StackInfo info = sinograms(31, 24, 1, 0.1, 0.1, 0);
  Image sinogram(31, 24);
  for (int a = 0; a < 24; ++a) {  // the shadow of a small blob at x = 0.8, y = 0.4 mm
    for (int c = 0; c < 31; ++c) {
      const double theta = a * std::numbers::pi / 12;
      const double t = (c - 15) * 0.1 - (0.8 * std::cos(theta) + 0.4 * std::sin(theta));
      sinogram(c, a) = static_cast<float>(std::exp(-t * t / 0.02));
    }
  }
  const ImagePlane canvas{31, 31, 0.1, 15, 15};
  Image sum(31, 31);
  for (int n = 0; n < 24; ++n) {
    const Image frame = smear(projection_at(sinogram, info, n * 15.0, 15), 0.1, n * std::numbers::pi / 12, canvas);
    for (std::size_t i = 0; i < sum.size(); ++i) sum.values[i] += frame.values[i];
  }
  float brightest = 0;
  int at_x = 0;
  int at_y = 0;
  for (const auto [y, x] : indices(31, 31)) {
    double dose = 0;  // independent: for each angle, the two columns around the pixel's shadow
    for (int a = 0; a < 24; ++a) {
      const double theta = a * std::numbers::pi / 12;
      const double t = 15 + (x - 15) * std::cos(theta) + (15 - y) * std::sin(theta);
      if (t < 0 || t > 30) continue;
      const int left = static_cast<int>(std::floor(t));
      const double part = t - left;
      dose += (1 - part) * static_cast<double>(sinogram(left, a)) +
              (left < 30 ? part * static_cast<double>(sinogram(left + 1, a)) : 0);
    }
    CHECK(sum(x, y) == doctest::Approx(dose).epsilon(1e-5));
    if (sum(x, y) > brightest) {
      brightest = sum(x, y);
      at_x = x;
      at_y = y;
    }
  }
  CHECK(at_x == 23);  // 0.8 mm to the right of the axis
  CHECK(at_y == 11);  // 0.4 mm above it
}

TEST_CASE("flatland takes the slice nearest to z; a z outside the stack is an error") {
  StackInfo info = sinograms(20, 12, 3, 0.1, 0.1, -0.1);
  const auto fed = [&](double z_mm) {
    FlatlandSlice slice("part.exr", info, {20, 20, 0.1, 9.5, 9.5}, z_mm);
    for (int k = 0; k < 3; ++k) slice.add(labelled(info, k), -0.1 + 0.1 * k);
    return slice;
  };
  CHECK(fed(0.04).peak() == labelled(info, 1)(17, 11));
  CHECK(fed(0.06).peak() == labelled(info, 2)(17, 11));
  const Image frame = fed(0).frame(90, 30);  // at 90 degrees t = y: row r shows column 19 - r
  CHECK(frame(3, 4) == doctest::Approx(labelled(info, 1)(15, 3)));
  CHECK(has(error_of([&] { fed(0.16).check(); }, vam::Fault::data), "z = 0.16 mm; its slices lie from -0.1 to 0.1 mm"));
}

TEST_CASE("slices may end with the projector's rows and no more than a hundredth beyond") {
  // Two slices of two rows each, from 1 row above to 1 row below z = 0: row of z is axis_row - z / 0.1.
  const StackInfo info = sinograms(20, 4, 2, 0.1, 0.2, -0.1);
  const auto fits = [&](double axis_row) {
    return !fault_of([&] { (void)composed(info, {20, 9, 0.1, axis_row, 0}); });
  };
  CHECK(fits(1.495));  // the upper slice from row -0.505
  CHECK_FALSE(fits(1.485));
  CHECK(fits(6.505));  // the lower one to row 8.505
  CHECK_FALSE(fits(6.515));
}
