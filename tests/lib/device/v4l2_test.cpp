// SPDX-License-Identifier: GPL-3.0-or-later
#include <linux/videodev2.h>
#include <pty.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "base/text/json.hpp"
#include "device/camera/camera_backends.hpp"
#include "lib/device/fake_v4l2.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;

namespace {

std::unique_ptr<Camera> v4l2(V4l2Script& script, VirtualClock& clock, const CameraSettings& settings = {}) {
  return open_v4l2_camera(parse_address("v4l2:/dev/video9", {"v4l2"}), settings,
                          std::make_unique<FakeV4l2>(script, clock), clock);
}

// What a call writes to standard error.
std::string said_by(const std::function<void()>& call) {
  const scratch::Folder folder;
  {
    const scratch::Redirect redirect(STDERR_FILENO, folder / "said");
    call();
  }
  return scratch::slurp(folder / "said");
}

}  // namespace

TEST_CASE("V4L2: stamps refer to the moment stated in the printer file, else to the driver's, which is recorded") {
  struct Case {
    const char* requested;
    __u32 source;
    const char* recorded;
    double middle_s;
  };
  for (const auto& [requested, source, recorded, middle_s] :
       {Case{"auto", V4L2_BUF_FLAG_TSTAMP_SRC_EOF, "end", 10.49},
        Case{"auto", V4L2_BUF_FLAG_TSTAMP_SRC_SOE, "start", 10.51},
        Case{"end", V4L2_BUF_FLAG_TSTAMP_SRC_SOE, "end", 10.49},
        Case{"middle", V4L2_BUF_FLAG_TSTAMP_SRC_EOF, "middle", 10.5},
        Case{"start", V4L2_BUF_FLAG_TSTAMP_SRC_EOF, "start", 10.51}}) {
    VirtualClock clock;
    V4l2Script script;
    script.flags |= source;
    const auto camera = v4l2(script, clock, CameraSettings{.exposure_us = 20000, .stamp = requested});
    CHECK(camera->identify()["stamp"] == recorded);
    camera->start();
    CHECK(camera->next()->time_s == doctest::Approx(middle_s));
  }
}

TEST_CASE("V4L2: frames without monotonic stamps are timed by arrival, by the shortest delay of 10 s") {
  VirtualClock clock;
  V4l2Script script{.flags = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN | V4L2_BUF_FLAG_TSTAMP_SRC_SOE,
                    .arrivals_s = {1010.530, 1011.502, 1014.590, 1015.510}};
  CameraSettings settings{.exposure_us = 20000, .stamp = "start"};
  const auto taken = [&] {
    const auto camera = v4l2(script, clock, settings);
    CHECK(camera->identify()["stamp"] == "arrival");
    camera->start();
    std::vector<double> times_s;
    for (int i = 0; i < 4; ++i) times_s.push_back(camera->next()->time_s);
    return times_s;
  };
  const auto stamped_s = taken();
  for (int i = 0; i < 4; ++i)
    CHECK(stamped_s[i] == doctest::Approx(std::vector{1010.520, 1011.492, 1014.492, 1015.492}[i]).epsilon(1e-9));
  script.flags = V4L2_BUF_FLAG_TIMESTAMP_COPY;  // of nothing: all are 0
  script.arrivals_s = {1110.530, 1111.502, 1114.590, 1115.510};
  const auto arrived_s = taken();
  for (int i = 0; i < 4; ++i) CHECK(arrived_s[i] == doctest::Approx(script.arrivals_s[i] - 0.01).epsilon(1e-9));
}

TEST_CASE("V4L2: stamps of another clock than stated are not believed, and the user is told once") {
  VirtualClock clock;
  V4l2Script script{.flags = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN,
                    .stated_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC,
                    .arrivals_s = {1010.5, 1011.6}};
  const auto camera = v4l2(script, clock);
  camera->start();
  const auto said = said_by([&] {
    CHECK(camera->next()->time_s == doctest::Approx(1010.5).epsilon(1e-9));
    CHECK(camera->next()->time_s == doctest::Approx(1011.5).epsilon(1e-9));
  });
  CHECK(said.find("frames are timed by arrival") == said.rfind("frames are timed by arrival"));
  CHECK(has(said, "/dev/video9: its time stamps are not of the clock that the driver stated"));
}

TEST_CASE("V4L2: automatics are switched off, gamma is linear, gain is set and read back") {
  VirtualClock clock;
  V4l2Script script;
  CHECK(v4l2(script, clock)->mode().gain == 17);  // as the camera has it
  CHECK(script.controls.at(V4L2_CID_AUTOGAIN) == 0);
  CHECK(script.controls.at(V4L2_CID_GAMMA) == 100);
  CameraSettings settings{.gain = 40};
  const auto camera = v4l2(script, clock, settings);
  CHECK(camera->mode().gain == 40);
  CHECK(camera->mode().gamma == 1.0);
  CHECK_FALSE(camera->mode().black_level.has_value());
  CHECK(camera->mode().automatic_off == std::vector<std::string>{"gain"});
  script.controls[V4L2_CID_AUTOGAIN] = 1;
  script.stuck = {V4L2_CID_AUTOGAIN};
  error_of([&] { (void)v4l2(script, clock, settings); }, Fault::protocol);
  settings.black_level = 3;
  script.stuck.clear();
  error_of([&] { (void)v4l2(script, clock, settings); }, Fault::usage);
}

TEST_CASE("V4L2: automatic exposure is switched off and read back") {
  VirtualClock clock;
  V4l2Script script;
  script.controls[V4L2_CID_EXPOSURE_AUTO] = V4L2_EXPOSURE_APERTURE_PRIORITY;
  CHECK(v4l2(script, clock)->mode().automatic_off == std::vector<std::string>{"gain", "exposure"});
  CHECK(script.controls.at(V4L2_CID_EXPOSURE_AUTO) == V4L2_EXPOSURE_MANUAL);
  script.refused[V4L2_CID_EXPOSURE_AUTO] = EACCES;  // but it is manual already
  CHECK(v4l2(script, clock)->mode().automatic_off.size() == 2);
  const auto refusal = [&] { return error_of([&] { (void)v4l2(script, clock); }, Fault::protocol); };
  for (const int reason : {EINVAL, ERANGE, EACCES}) {
    script.controls[V4L2_CID_EXPOSURE_AUTO] = V4L2_EXPOSURE_APERTURE_PRIORITY;
    script.refused[V4L2_CID_EXPOSURE_AUTO] = reason;
    CHECK(has(refusal(), std::string("automatic exposure cannot be switched off (") + std::strerror(reason)));
  }
  script.refused.clear();
  script.stuck = {V4L2_CID_EXPOSURE_AUTO};
  CHECK(has(refusal(), "automatic exposure cannot be switched off (reads back as 3 instead of 1)"));
  script.unread[V4L2_CID_EXPOSURE_AUTO] = EACCES;
  CHECK(has(refusal(), "does not report whether its automatic exposure is off"));
  script.unread[V4L2_CID_EXPOSURE_AUTO] = ENODEV;
  error_of([&] { (void)v4l2(script, clock); }, Fault::absent);
}

TEST_CASE("V4L2: an exposure or a gain between the steps of the camera is refused with both values") {
  VirtualClock clock;
  V4l2Script script;
  const auto refusal = [&](const CameraSettings& settings) {
    return error_of([&] { (void)v4l2(script, clock, settings); }, Fault::protocol);
  };
  CameraSettings settings{.exposure_us = 16667};
  CHECK(v4l2(script, clock, settings)->mode().exposure_us == 16700);
  for (const auto& [wanted_us, got] :
       {std::pair(40.0, "0 instead of 40"), std::pair(50.0, "100 instead of 50"),
        std::pair(149.0, "100 instead of 149"), std::pair(250.0, "300 instead of 250")}) {
    settings.exposure_us = wanted_us;
    CHECK(has(refusal(settings), std::string("the exposure (us, in steps of 100) reads back as ") + got));
  }
  settings.exposure_us.reset();
  settings.gain = 1.5;
  CHECK(has(refusal(settings), "the gain reads back as 2 instead of 1.5"));
  settings.gain = 0.4;
  CHECK(has(refusal(settings), "the gain reads back as 0 instead of 0.4"));
  settings.gain = 100.4;
  CHECK(v4l2(script, clock, settings)->mode().gain == 100);
}

TEST_CASE("V4L2: a camera without an exposure time is refused with what it has") {
  VirtualClock clock;
  V4l2Script script{.exposes = false};
  CHECK(v4l2(script, clock)->mode().exposure_us == 0);
  CameraSettings settings{.exposure_us = 20000};
  const auto refusal = [&] { return error_of([&] { (void)v4l2(script, clock, settings); }, Fault::usage); };
  CHECK(has(refusal(), "has no exposure time (V4L2_CID_EXPOSURE_ABSOLUTE); use another camera"));
  script.controls[V4L2_CID_EXPOSURE] = 7;
  CHECK(has(refusal(), "only an exposure without unit (V4L2_CID_EXPOSURE); use another camera"));
}

TEST_CASE("V4L2: a rate that cannot be set is taken where it agrees, and told where it is not known") {
  VirtualClock clock;
  V4l2Script script{.rate_limit = 30, .rate_errno = ENOTTY};
  CameraSettings settings{.fps = 30};
  CHECK(said_by([&] { CHECK(v4l2(script, clock, settings)->mode().fps == doctest::Approx(30)); }).empty());
  settings.fps = 25;
  const auto call = [&] { (void)v4l2(script, clock, settings); };
  CHECK(has(error_of(call, Fault::protocol), "the frame rate reads back as 30 instead of 25"));
  script.hides_rate = true;
  CHECK(has(said_by([&] { CHECK(v4l2(script, clock, settings)->mode().fps == 0); }),
            "frames come at the camera's own rate, not necessarily at 25 Hz"));
  script.rate_errno = EINVAL;
  CHECK(has(error_of(call, Fault::protocol), "rejects the frame rate (VIDIOC_S_PARM)"));
}

TEST_CASE("V4L2: a rate within a hundredth of the requested one is taken for it") {
  VirtualClock clock;
  V4l2Script script;
  CameraSettings settings{.fps = 10000};
  script.rate_limit = 9900;
  CHECK(v4l2(script, clock, settings)->mode().fps == 9900);
  script.rate_limit = 9899;
  CHECK(has(error_of([&] { (void)v4l2(script, clock, settings); }, Fault::protocol),
            "the frame rate reads back as 9899 instead of 10000"));
}

TEST_CASE("V4L2: luma is of limited range unless the driver says otherwise") {
  struct Case {
    __u32 quantization, colorspace;
    bool limited;
  };
  for (const auto& [quantization, colorspace, limited] :
       {Case{V4L2_QUANTIZATION_DEFAULT, V4L2_COLORSPACE_SRGB, true},
        Case{V4L2_QUANTIZATION_DEFAULT, V4L2_COLORSPACE_JPEG, false},
        Case{V4L2_QUANTIZATION_LIM_RANGE, V4L2_COLORSPACE_JPEG, true},
        Case{V4L2_QUANTIZATION_FULL_RANGE, V4L2_COLORSPACE_SRGB, false}}) {
    for (const auto format : {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_GREY}) {
      VirtualClock clock;
      V4l2Script script{.formats = {format}};
      script.sequence = {229};  // and with it the first byte
      script.quantization = quantization;
      script.colorspace = colorspace;
      const auto camera = v4l2(script, clock);
      camera->start();
      const auto values = camera->next()->levels.values;
      const bool widened = limited && format == V4L2_PIX_FMT_YUYV;
      CHECK(values[0] == (widened ? 248 : 229));
      CHECK(values[3] == (format == V4L2_PIX_FMT_GREY ? 232 : widened ? 255 : 235));
    }
  }
}

TEST_CASE("V4L2: the luma of UYVY is every second byte from the second on") {
  VirtualClock clock;
  V4l2Script script{.formats = {V4L2_PIX_FMT_UYVY}, .sequence = {49}, .quantization = V4L2_QUANTIZATION_FULL_RANGE};
  const auto camera = v4l2(script, clock);
  camera->start();
  CHECK(camera->next()->levels.values == std::vector<std::uint16_t>{50, 52, 54, 56, 58, 60, 62, 64});
}

TEST_CASE("V4L2: interlaced fields and an address without a path are refused") {
  VirtualClock clock;
  V4l2Script script;
  for (const __u32 field : {V4L2_FIELD_ALTERNATE, V4L2_FIELD_INTERLACED, V4L2_FIELD_TOP}) {
    script.field = field;
    CHECK(has(error_of([&] { (void)v4l2(script, clock); }, Fault::usage), "sends interlaced fields (V4L2 field "));
  }
  const auto open = [&] {
    (void)open_v4l2_camera(parse_address("v4l2:", {"v4l2"}), {}, std::make_unique<FakeV4l2>(script, clock), clock);
  };
  CHECK(has(error_of(open, Fault::usage), "device 'v4l2:': names no camera; give v4l2:PATH, e.g. v4l2:/dev/video0"));
}

TEST_CASE("V4L2: a known depth is preferred, and one that is not known is told") {
  VirtualClock clock;
  V4l2Script script;
  const auto said = [&](int bits) { return said_by([&] { CHECK(v4l2(script, clock)->mode().bits == bits); }); };
  script.formats = {V4L2_PIX_FMT_Y16, V4L2_PIX_FMT_Y10};
  CHECK(said(10).empty());
  script.formats = {V4L2_PIX_FMT_Y10, V4L2_PIX_FMT_Y12};
  CHECK(said(12).empty());
  script.formats = {V4L2_PIX_FMT_Y16};
  CHECK(has(said(16), "/dev/video9: the depth of Y16 is not known, full scale is taken as 65535"));
}

TEST_CASE("V4L2: grey first, settings read back, sequence gaps and the error flag") {
  VirtualClock clock;
  V4l2Script script;
  CameraSettings settings{.exposure_us = 20000, .fps = 25};
  script.short_sequence = 14;
  const auto camera = v4l2(script, clock, settings);
  CHECK(camera->identify()["model"] == "fake");
  CHECK(camera->mode().columns == 4);
  CHECK(camera->mode().fps == doctest::Approx(25));
  CHECK(script.exposure == 200);
  camera->start();
  std::vector<long> numbers;
  std::vector<bool> complete;
  for (int i = 0; i < 4; ++i) {
    const auto frame = camera->next();
    REQUIRE(frame.has_value());
    numbers.push_back(frame->number);
    complete.push_back(frame->complete);
    if (i == 1) {
      CHECK(frame->time_s == doctest::Approx(11.49));  // half an exposure before the stamp
      CHECK(frame->levels.values == std::vector<std::uint16_t>{11, 12, 13, 14, 17, 18, 19, 20});
    }
  }
  CHECK(numbers == std::vector<long>{0, 1, 4, 5});
  CHECK(complete == std::vector<bool>{true, true, false, false});
  const double before_s = clock.now_s();
  CHECK(fault_of([&] { (void)camera->next(); }) == Fault::busy);
  CHECK(clock.now_s() - before_s < 1.5);
  script.gone = true;
  CHECK(fault_of([&] { (void)camera->next(); }) == Fault::absent);
}

TEST_CASE("V4L2: a camera that stops sending is queried once: busy if it answers, else disconnected") {
  const auto failure = [](V4l2Script script, Fault fault) {
    VirtualClock clock;
    script.sequence = {10};
    const auto camera = v4l2(script, clock);
    camera->start();
    CHECK(camera->next()->number == 0);
    script.queries = 0;
    const std::string line = error_of([&] { (void)camera->next(); }, fault);
    CHECK(script.queries <= 1);
    return line;
  };
  V4l2Script script;
  CHECK(has(failure(script, Fault::busy), "/dev/video9: no frame within 1 s, although the camera responds; check"));
  script.rate_errno = EINVAL;
  script.hides_rate = true;  // one frame a second, for all that is known
  CHECK(has(failure(script, Fault::busy), "/dev/video9: no frame within 4 s"));
  script.hides_rate = false;
  script.ended = true;
  CHECK(has(failure(script, Fault::busy), "the stream has ended (POLLERR), although the camera responds"));
  script.dequeue_errno = EIO;
  CHECK(has(failure(script, Fault::busy), "(VIDIOC_DQBUF: Input/output error), although the camera responds"));
  script.gone = true;
  CHECK(has(failure(script, Fault::absent), "the camera is disconnected (No such device); check cable and power"));
  script.dequeue_errno = ENODEV;
  CHECK(has(failure(script, Fault::absent), "the camera is disconnected (No such device)"));
  script.dequeue_errno = 0;
  CHECK(has(failure(script, Fault::absent), "the camera is disconnected (No such device)"));
}

TEST_CASE("V4L2: an unsupported setting is named in the error") {
  VirtualClock clock;
  V4l2Script script;
  const auto fault = [&](const CameraSettings& settings) {
    return fault_of([&] { (void)v4l2(script, clock, settings); });
  };
  CameraSettings fast{.fps = 60};
  script.rate_limit = 30;
  CHECK(fault(fast) == Fault::protocol);
  CHECK(fault(CameraSettings{.binning = 2}) == Fault::usage);
  CameraSettings deep{.format = "Y16"};
  CHECK(fault(deep) == Fault::usage);
  CHECK(has(message_of([&] { (void)v4l2(script, clock, deep); }), "no pixel format Y16; it has YUYV, GREY, supported"));
  script.formats = {V4L2_PIX_FMT_MJPEG, V4L2_PIX_FMT_NV12, V4L2_PIX_FMT_Y16_BE};
  CHECK(has(message_of([&] { (void)v4l2(script, clock); }),
            "no pixel format for grey; it has MJPG, NV12, Y16-BE, supported are GREY, Y12, Y10, Y16, YUYV, UYVY; use"));
  script.formats.clear();
  CHECK(has(message_of([&] { (void)v4l2(script, clock); }), "no pixel format for grey; it has none, supported"));
  script.formats = {V4L2_PIX_FMT_GREY};
  script.streams = false;
  CHECK(fault({}) == Fault::usage);
  script.refuse_open = EBUSY;
  CHECK(fault({}) == Fault::busy);
  script.refuse_open = ENOENT;
  CHECK(fault({}) == Fault::absent);
}

TEST_CASE("V4L2: the kernel's node has a frame, none in time, or is gone") {
  int leader = -1, terminal = -1;  // a node that can be unplugged
  std::array<char, 64> name{};
  REQUIRE(openpty(&leader, &terminal, name.data(), nullptr, nullptr) == 0);
  const auto driver = kernel_v4l2();
  REQUIRE(driver->open(name.data()) >= 0);
  close(terminal);
  CHECK(driver->wait(0.01) == 0);
  REQUIRE(write(leader, "x\n", 2) == 2);
  CHECK(driver->wait(1) == 1);
  v4l2_capability about{};
  CHECK(driver->control(VIDIOC_QUERYCAP, &about) == -1);
  close(leader);
  CHECK(driver->wait(1) == -1);
}
