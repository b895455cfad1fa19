// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/camera.hpp"

#include <memory>
#include <set>
#include <utility>

#include "base/text/json.hpp"
#include "device/camera/camera_backends.hpp"
#include "device/camera/capture.hpp"
#include "device/camera/private/frame_count.hpp"
#include "device/camera/private/grey_pixels.hpp"
#include "device/camera/private/read_clock.hpp"
#include "device/open/open.hpp"
#include "sim/cameras/camera.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;

namespace {

// A recording of that many frames, a tenth of a second and step_deg apart; those in `lost` are not in it.
CameraBench recording(int count, double step_deg, std::set<long> lost, std::set<long> cut) {
  return {[=](const std::string&) -> CameraFeed {
            return [=, next = 0L](CapturedFrame& frame) mutable {
              while (lost.contains(next)) ++next;
              if (next >= count) return false;
              frame = {};
              frame.levels = GreyImage(2, 2, 8);
              frame.number = next;
              frame.time_s = 7 + 0.1 * static_cast<double>(next);
              frame.angle_deg = step_deg * static_cast<double>(next);
              frame.complete = !cut.contains(next);
              ++next;
              return true;
            };
          },
          {},
          {}};
}

struct Taken {
  std::vector<long> places, numbers, gaps;
  CaptureTally tally;
};

Taken take(const CameraBench& bench, const CapturePlan& plan, AngleSource* angles = nullptr) {
  VirtualClock clock;
  const auto camera = open_camera("replay:x", {}, bench, clock);
  Taken taken;
  taken.tally = capture(*camera, angles, plan,
                        {[&](long place) { return std::count(taken.places.begin(), taken.places.end(), place) == 0; },
                         [&](Shot&& shot) {
                           taken.places.push_back(shot.place);
                           taken.numbers.push_back(shot.frame.number);
                         },
                         [&](long first, long last) {
                           taken.gaps.push_back(first);
                           taken.gaps.push_back(last);
                         }});
  return taken;
}

}  // namespace

TEST_CASE("Frame ids: gaps are counted, GigE ids wrap after 65535, a malformed one counts as the next frame") {
  FrameCount count;
  CHECK(count.number(65530) == 0);
  CHECK(count.number(65533) == 3);
  CHECK(count.number(std::nullopt) == 4);  // 65534
  CHECK(count.number(2) == 7);             // 65535, 1, 2
  CHECK(count.number(60000) == 8);         // too far ahead: an id of long ago
  CHECK(count.number(5) == 10);            // after 3: 4 was lost
  FrameCount usb;
  CHECK(usb.number(0) == 0);
  CHECK(usb.number(1) == 1);
  CHECK(usb.number(70000 - 69000) == 1000);
  CHECK(usb.number(2000) == 2000);  // the widest gap that is believed
  CHECK(usb.number(3001) == 2001);
  FrameCount round;
  CHECK(round.number(65535) == 0);
  CHECK(round.number(std::nullopt) == 1);  // 1
  CHECK(round.number(2) == 2);
  CHECK(round.number(2) == 3);  // the same again is no frame of its own: 3
  CHECK(round.number(4) == 4);
  FrameCount beyond;
  CHECK(beyond.number(65536) == 0);
  CHECK(beyond.number(1) == 1);  // no GigE id went before it
}

TEST_CASE("Time stamps: the shortest delay is used for all, and follows a drifting clock") {
  StampClock clock(10);
  CHECK(clock.host_s(5, 105.030) == doctest::Approx(105.030));
  CHECK(clock.host_s(6, 106.002) == doctest::Approx(106.002));
  CHECK(clock.host_s(7, 107.090) == doctest::Approx(107.002));
  CHECK(clock.host_s(16, 116.050) == doctest::Approx(116.002));
  CHECK(clock.host_s(18, 118.050) == doctest::Approx(118.050));  // all before are older than 10 s
  CHECK(clock.host_s(3, 203.2) == doctest::Approx(203.2));       // the camera's clock began anew
  CHECK(clock.host_s(4, 204.3) == doctest::Approx(204.2));
}

TEST_CASE("A camera's clock: the offset that is consistent with all readings, until the clocks have drifted apart") {
  ReadClock clock;
  CHECK_FALSE(clock.ready());
  clock.add({5, 105, 105.010});  // its middle is 3 ms late
  clock.add({5.5, 105.5015, 105.5025});
  const auto host_s = [&](double device_s) { return clock.host_s(device_s, 100.01 + device_s, 0.02).value(); };
  CHECK(host_s(6) == doctest::Approx(106.002).epsilon(1e-9));
  CHECK(clock.doubt_s() == doctest::Approx(0.0005));
  clock.add({8, 108.0025, 108.0095});  // its middle is 4 ms late, but it is not earlier than 2.5 ms
  CHECK(host_s(6) == doctest::Approx(106.0025 + 0.5 * 2.5 * 5e-5).epsilon(1e-8));
  clock.add({14, 114.0020, 114.0034});  // the clocks drift by 50 ppm: 0.4 ms since the good one
  CHECK(host_s(14) == doctest::Approx(114.0 + 0.5 * (0.0025 - 6 * 5e-5 + 0.0025 + 8.5 * 5e-5)).epsilon(1e-8));
  clock.add({15, 115.010, 115.011});  // something else happened: the narrowest
  CHECK(host_s(15) == doctest::Approx(115.0105).epsilon(1e-9));
}

TEST_CASE("A camera's clock: many readings delayed on either side determine it far better than one") {
  std::mt19937_64 random(5);
  std::exponential_distribution<double> held_up_s(1 / 0.001);
  std::vector<double> ratios;
  for (int run = 0; run < 200; ++run) {
    ReadClock clock;
    for (int n = 0; n < 60; ++n) {
      const double latched_s = 0.015 * n;
      clock.add({latched_s, 100 + latched_s - held_up_s(random), 100 + latched_s + held_up_s(random)});
    }
    const double off_s = std::abs(clock.host_s(5, 105.01, 0.02).value() - 105);
    CHECK(off_s <= clock.doubt_s());
    CHECK(off_s < 0.0002);
    ratios.push_back(off_s / clock.sigma_s());
  }
  std::sort(ratios.begin(), ratios.end());
  CHECK(ratios[100] > 0.3);  // and the sigma is no larger than need be
}

TEST_CASE("A camera's clock: a stamp after its frame, or long before it, is of another clock") {
  ReadClock clock;
  clock.add({5, 105, 105});
  CHECK(clock.host_s(6, 106.01, 2).has_value());
  CHECK(clock.host_s(6, 117.9, 2).has_value());
  CHECK_FALSE(clock.host_s(6, 118.1, 2));
  CHECK_FALSE(clock.host_s(6, 105.9, 2));
}

TEST_CASE("A camera's clock: stamps are believed to their last allowance, readings for 10 s") {
  ReadClock clock;
  clock.add({5, 105, 105.002});
  // The offset is 100.001 +- 0.001 s; a time of arrival may be 20 ms early, a frame 10 s and its exposure old.
  CHECK(clock.host_s(6, 105.9801, 2).has_value());
  CHECK_FALSE(clock.host_s(6, 105.9799, 2));
  CHECK(clock.host_s(6, 118.0009, 2).has_value());
  CHECK_FALSE(clock.host_s(6, 118.0011, 2));
  clock.add({15, 115, 115.01});  // the first ends 10.008 s before: its 2 ms are forgotten
  CHECK(clock.doubt_s() == doctest::Approx(0.005).epsilon(1e-9));
  CHECK(clock.sigma_s() == doctest::Approx(0.005 / std::sqrt(3.0)).epsilon(1e-9));
}

TEST_CASE("The moment of a time stamp: as requested, as the maker documents it, else the end") {
  CHECK(stamp_moment("auto", "Basler") == StampMoment::start);
  CHECK(stamp_moment("auto", "Teledyne DALSA") == StampMoment::start);
  CHECK(stamp_moment("auto", "FLIR") == StampMoment::end);
  CHECK(stamp_moment("start", "FLIR") == StampMoment::start);
  CHECK(std::string(word_of(StampMoment::middle)) == "middle");
  CHECK(std::string(word_of(StampMoment::end)) == "end");
  CHECK(stamp_moment("auto", "Somebody") == StampMoment::end);
  CHECK(stamp_moment("middle", "Basler") == StampMoment::middle);
  CHECK(to_middle_s(StampMoment::start, 0.02) == 0.01);
  CHECK(to_middle_s(StampMoment::middle, 0.02) == 0);
  CHECK(to_middle_s(StampMoment::end, 0.02) == -0.01);
}

TEST_CASE("A camera is waited for three periods and an exposure beyond a second, or as long as requested") {
  CameraSettings settings;
  CHECK(settings.patience_s(0.5) == doctest::Approx(2.5));
  settings.exposure_us = 2e6;
  CHECK(settings.patience_s(0.5) == doctest::Approx(4.5));
  settings.timeout_s = 0.25;
  CHECK(settings.patience_s(0.5) == 0.25);
  CameraMode mode{.columns = 4, .rows = 3};
  CHECK_FALSE(another_size(mode, 4, 3));
  CHECK(another_size(mode, 4, 2) == "4 x 2 pixels instead of 4 x 3");
  CHECK(another_size(mode, 5, 3) == "5 x 3 pixels instead of 4 x 3");
}

TEST_CASE("Pixels: padded rows, luma of YUYV, 10 and 12 bits spread so that full stays full") {
  GreyImage image;
  const std::vector<std::uint8_t> padded{1, 2, 0, 3, 4, 0};
  CHECK(to_grey(padded, 2, 2, 3, PixelLayout::bytes, 8, image));
  CHECK(image.values == std::vector<std::uint16_t>{1, 2, 3, 4});
  CHECK(to_grey(padded, 3, 1, 0, PixelLayout::even_bytes, 8, image));
  CHECK(image.values == std::vector<std::uint16_t>{1, 0, 4});
  CHECK(to_grey(padded, 3, 1, 0, PixelLayout::odd_bytes, 8, image));
  CHECK(image.values == std::vector<std::uint16_t>{2, 3, 0});
  const std::vector<std::uint8_t> deep{0xff, 0x0f, 0x00, 0x08};
  CHECK(to_grey(deep, 2, 1, 0, PixelLayout::words, 12, image));
  CHECK(image.values == std::vector<std::uint16_t>{0xffff, 0x8008});
  CHECK_FALSE(to_grey(deep, 3, 1, 0, PixelLayout::words, 12, image));
  CHECK(to_grey(deep, 2, 1, 0, PixelLayout::words, 10, image));  // more than 10 bits have is full
  CHECK(image.values == std::vector<std::uint16_t>{0xffff, 0xffff});
  CHECK(to_grey(deep, 2, 1, 0, PixelLayout::words, 16, image));
  CHECK(image.values == std::vector<std::uint16_t>{0x0fff, 0x0800});
  const std::vector<std::uint8_t> quarter{0x00, 0x01};
  CHECK(to_grey(quarter, 1, 1, 0, PixelLayout::words, 10, image));
  CHECK(image.values == std::vector<std::uint16_t>{0x4010});
}

TEST_CASE("Pixels: luma of limited range fills the levels from black to full") {
  GreyImage image(7, 1, 8);
  image.values = {0, 16, 17, 126, 234, 235, 255};
  widen_luma(image);
  CHECK(image.values == std::vector<std::uint16_t>{0, 0, 1, 128, 254, 255, 255});
}

TEST_CASE("A series by count, by number and by angle; lost frames are counted") {
  const auto bench = recording(20, 10, {3, 4}, {7});
  CapturePlan plan{.frames = 6};
  Taken taken = take(bench, plan);
  CHECK(taken.places == std::vector<long>{0, 1, 2, 3, 4, 5});
  CHECK(taken.numbers == std::vector<long>{0, 1, 2, 5, 6, 7});
  CHECK(taken.gaps == std::vector<long>{3, 4});
  CHECK(taken.tally.dropped == 2);
  CHECK(taken.tally.incomplete == 1);
  CHECK(taken.tally.missing == 0);

  plan.by_number = true;
  taken = take(bench, plan);
  CHECK(taken.places == std::vector<long>{0, 1, 2, 5});
  CHECK(taken.tally.missing == 2);

  plan.by_number = false;
  plan.every_deg = 20;  // two frames for each place but those at the ends
  taken = take(bench, plan);
  CHECK(taken.places == std::vector<long>{0, 1, 3, 4, 5});
  CHECK(taken.numbers == std::vector<long>{0, 2, 6, 8, 10});
  CHECK(taken.tally.missing == 1);

  plan.max_lost = 2;
  CHECK(fault_of([&] { (void)take(bench, plan); }) == Fault::busy);
  plan.max_lost.reset();
  plan.every_deg.reset();
  plan.frames = 0;
  CHECK(take(bench, plan).tally.frames == 18);
}

TEST_CASE("A followed series begins at angle 0 and keeps the frame nearest to each angle") {
  class Steady final : public AngleSource {
   public:
    void update() override {}
    std::optional<AngleSample> at(double t_s) const override {
      if (t_s < 7.15) return std::nullopt;
      return AngleSample{t_s, 33 * (t_s - 7.5), 0.01};
    }
  } angles;
  CapturePlan plan{.frames = 4, .by_number = true, .latency_s = 0.05};
  Taken taken = take(recording(20, 0, {}, {}), plan, &angles);
  CHECK(taken.numbers == std::vector<long>{6, 7, 8, 9});  // 7.6 s less 50 ms is the first after 7.5 s
  CHECK(taken.places == std::vector<long>{0, 1, 2, 3});
  plan.every_deg = 10;
  taken = take(recording(20, 0, {}, {}), plan, &angles);
  CHECK(taken.places == std::vector<long>{0, 1, 2, 3});
  CHECK(taken.numbers == std::vector<long>{5, 9, 12, 15});  // 7.45 s, 7.85 s, 8.15 s, 8.45 s
}

TEST_CASE("A simulated camera: virtual pace does not wait, lost and cut frames, a pulled cable") {
  VirtualClock clock;
  CameraSettings settings{.fps = 10, .binning = 8};
  const auto camera = open_camera("sim:?pace=virtual&drop=1&incomplete=2&unplug=4", settings, {}, clock);
  CHECK(camera->mode().columns == 90);
  camera->start();
  CHECK(camera->next()->number == 0);
  const auto cut = camera->next();
  CHECK(cut->number == 2);
  CHECK_FALSE(cut->complete);
  const auto whole = camera->next();
  CHECK(whole->number == 3);
  CHECK(whole->time_s == doctest::Approx(clock.now_s() + 0.3));
  CHECK(fault_of([&] { (void)camera->next(); }) == Fault::absent);
  settings.trigger = "software";
  const auto triggered = open_camera("sim:", settings, {}, clock);
  triggered->start();
  CHECK(fault_of([&] { (void)triggered->next(); }) == Fault::busy);
  triggered->trigger();
  CHECK(triggered->next()->complete);
  settings.trigger = "free";
  const auto shrinking = open_camera("sim:?pace=virtual&shrink=1", settings, {}, clock);
  shrinking->start();
  CHECK(shrinking->next()->complete);
  CHECK(has(message_of([&] { (void)shrinking->next(); }), "90 x 33 pixels instead of 90 x 67"));
}

TEST_CASE("A camera's address and settings are checked before anything is opened") {
  VirtualClock clock;
  const auto fault = [&](const std::string& device, const CameraSettings& settings = {}) {
    return fault_of([&] { (void)open_camera(device, settings, recording(1, 0, {}, {}), clock); });
  };
  CHECK(fault("usb:1") == Fault::usage);
  CHECK(fault("sim:x") == Fault::usage);
  CHECK(fault("sim:?colums=3") == Fault::usage);
  CHECK(fault("sim:?drop=a") == Fault::usage);
  CHECK(fault("sim:?part=cube") == Fault::usage);
  CHECK(fault("sim:?part=sphere:height=3") == Fault::usage);
  CHECK(fault("sim:?bits=12") == Fault::usage);
  CameraSettings wrong{.trigger = "Line0"};
  CHECK(fault("sim:", wrong) == Fault::usage);
  wrong = {};
  wrong.binning = 1000;
  CHECK(fault("sim:", wrong) == Fault::usage);
  CHECK(fault("replay:x?pace=fast") == Fault::usage);
  CHECK(fault("v4l2:/dev/null?buffer=3") == Fault::usage);
  CHECK(fault_of([&] { (void)open_camera("replay:x", {}, recording(0, 0, {}, {}), clock); }) == Fault::data);
}
