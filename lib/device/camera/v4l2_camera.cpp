// SPDX-License-Identifier: GPL-3.0-or-later
// Video4Linux2 by its own calls: streaming with memory-mapped buffers.
#include <linux/videodev2.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/camera/camera_backends.hpp"
#include "device/camera/private/frame_count.hpp"
#include "device/camera/private/grey_pixels.hpp"
#include "device/camera/private/v4l2_node.hpp"
#include "device/os/interrupt.hpp"

namespace vam::device {

namespace {

struct Mapping {
  void* start = nullptr;
  std::size_t size = 0;
};

class V4l2Camera final : public Camera {
 public:
  V4l2Camera(const Address& address, const CameraSettings& settings, std::unique_ptr<V4l2Driver> driver, Clock& clock)
      : node_{address.place, std::move(driver)}, settings_(settings), clock_(clock) {
    if (node_.driver->open(node_.path.c_str()) < 0) {
      const int reason = errno;
      const char* remedy = reason == EACCES  ? "; add the user to the group that owns it (usually video)"
                           : reason == EBUSY ? "; end the program that uses it"
                                             : "; vam-devices lists the cameras";
      throw Error{reason == EBUSY ? Fault::busy : Fault::absent,
                  node_.path + ": cannot open: " + std::strerror(reason) + remedy};
    }
    check_capture();
    format_ = choose_format(node_, settings_.format, mode_);
    set_controls(node_, settings_, mode_);
    map_buffers(address.integer("buffers", 2, 64).value_or(10));
  }

  ~V4l2Camera() override {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (streaming_) node_.driver->control(VIDIOC_STREAMOFF, &type);
    for (const auto& mapping : mappings_) node_.driver->unmap(mapping.start, mapping.size);
    node_.driver->close();
  }

  Json identify() override { return about_; }
  CameraMode mode() const override { return mode_; }
  void trigger() override { throw Error{Fault::usage, node_.path + ": V4L2 has no software trigger"}; }

  void start() override {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    node_.ask(VIDIOC_STREAMON, &type, "does not start (VIDIOC_STREAMON)");
    streaming_ = true;
  }

  std::optional<CapturedFrame> next() override {
    const double patience_s = settings_.patience_s(mode_.fps > 0 ? 1 / mode_.fps : 1);
    const double limit_s = clock_.now_s() + patience_s;
    for (;;) {
      check_interrupted();
      const double left_s = limit_s - clock_.now_s();
      if (left_s <= 0) throw silent("no frame within " + format_number(patience_s, 3) + " s");
      const int ready = node_.driver->wait(std::min(left_s, 0.2));
      if (ready < 0) throw silent("the stream has ended (POLLERR)");
      if (ready == 0) continue;
      auto buffer = capture_buffer();
      if (node_.driver->control(VIDIOC_DQBUF, &buffer) == 0) return take(buffer);
      if (errno != EAGAIN) throw silent(std::string("no frame (VIDIOC_DQBUF: ") + std::strerror(errno) + ")");
    }
  }

 private:
  // Silent, or gone? It tells its name or it does not.
  [[nodiscard]] Error silent(const std::string& what) const {
    auto about = cleared<v4l2_capability>();
    if (node_.driver->control(VIDIOC_QUERYCAP, &about) != 0) return node_.gone();
    return {Fault::busy,
            node_.path + ": " + what + ", although the camera responds; check cable, trigger and other streams"};
  }

  static v4l2_buffer capture_buffer() {
    auto buffer = cleared<v4l2_buffer>();
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    return buffer;
  }

  void check_capture() {
    auto what = cleared<v4l2_capability>();
    node_.ask(VIDIOC_QUERYCAP, &what, "is no video device (VIDIOC_QUERYCAP)");
    const std::uint32_t able = (what.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? what.device_caps : what.capabilities;
    if ((able & V4L2_CAP_VIDEO_CAPTURE) == 0 || (able & V4L2_CAP_STREAMING) == 0) {
      throw Error{Fault::usage, node_.path + ": cannot stream images; a camera has several nodes, try the next"};
    }
    const auto text = [](const __u8* bytes) { return std::string(reinterpret_cast<const char*>(bytes)); };
    about_ = {{"maker", text(what.driver)}, {"model", text(what.card)}, {"serial", text(what.bus_info)}};
    about_["firmware"] = std::to_string(what.version >> 16 & 255) + "." + std::to_string(what.version >> 8 & 255);
  }

  void map_buffers(int count) {
    auto wanted = cleared<v4l2_requestbuffers>();
    wanted.count = static_cast<std::uint32_t>(count);
    wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    wanted.memory = V4L2_MEMORY_MMAP;
    node_.ask(VIDIOC_REQBUFS, &wanted, "provides no buffers (VIDIOC_REQBUFS)");
    for (std::uint32_t i = 0; i < wanted.count; ++i) {
      auto buffer = capture_buffer();
      buffer.index = i;
      node_.ask(VIDIOC_QUERYBUF, &buffer, "does not describe its buffers (VIDIOC_QUERYBUF)");
      void* start = node_.driver->map(buffer.length, buffer.m.offset);
      if (start == MAP_FAILED) throw Error{Fault::memory, node_.path + ": a buffer cannot be mapped"};
      mappings_.push_back({start, buffer.length});
      if (i == 0) read_convention(buffer.flags);
      node_.ask(VIDIOC_QBUF, &buffer, "rejects a buffer (VIDIOC_QBUF)");
    }
    if (mappings_.empty()) throw Error{Fault::memory, node_.path + ": provides no buffers"};
  }

  static bool is_monotonic(std::uint32_t flags) {
    return (flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  }

  // What time stamps name, the same for all buffers: as the driver says, unless the printer file knows better.
  void read_convention(std::uint32_t flags) {
    const bool at_start = (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    const std::string driver = word_of(at_start ? StampMoment::start : StampMoment::end);
    if (is_monotonic(flags)) moment_ = stamp_moment(settings_.stamp == "auto" ? driver : settings_.stamp, "");
    about_["stamp"] = moment_ ? word_of(*moment_) : "arrival";
  }

  // The middle of the exposure. Stamps of another clock are as good as the shortest way of a frame, which begins at
  // the end of the exposure; those that do not advance are none.
  double middle_s(double stamp_s, std::uint32_t flags) {
    const double exposure_s = 1e-6 * mode_.exposure_us;
    if (moment_ && is_monotonic(flags)) return stamp_s + to_middle_s(*moment_, exposure_s);
    if (moment_) tell_arrival();
    const bool advances = stamp_s > last_stamp_s_;
    last_stamp_s_ = stamp_s;
    if (!advances) arrivals_ = StampClock();
    const double arrived_s = clock_.now_s();
    return (advances ? arrivals_.host_s(stamp_s, arrived_s) : arrived_s) + to_middle_s(StampMoment::end, exposure_s);
  }

  void tell_arrival() {
    if (!std::exchange(told_arrival_, true)) {
      warn(node_.path + ": its time stamps are not of the clock that the driver stated; frames are timed by arrival");
    }
  }

  CapturedFrame take(v4l2_buffer& buffer) {
    if (buffer.index >= mappings_.size()) throw Error{Fault::protocol, node_.path + ": returned an unknown buffer"};
    const Mapping& mapping = mappings_[buffer.index];
    CapturedFrame frame;
    frame.number = count_.number(buffer.sequence);
    frame.complete = (buffer.flags & V4L2_BUF_FLAG_ERROR) == 0;
    const double stamp_s =
        static_cast<double>(buffer.timestamp.tv_sec) + 1e-6 * static_cast<double>(buffer.timestamp.tv_usec);
    frame.time_s = middle_s(stamp_s, buffer.flags);
    frame.device_s = stamp_s;
    const auto used = std::min<std::size_t>(buffer.bytesused, mapping.size);
    const bool whole = to_grey({static_cast<const std::uint8_t*>(mapping.start), used}, mode_.columns, mode_.rows,
                               format_.stride, format_.layout, format_.bits, frame.levels);
    if (format_.limited_range) widen_luma(frame.levels);
    frame.complete = frame.complete && whole;
    node_.ask(VIDIOC_QBUF, &buffer, "rejects a returned buffer (VIDIOC_QBUF)");
    return frame;
  }

  V4l2Node node_;
  CameraSettings settings_;
  Clock& clock_;
  Json about_;
  CameraMode mode_;
  V4l2Format format_;
  std::vector<Mapping> mappings_;
  bool streaming_ = false;
  FrameCount count_;
  std::optional<StampMoment> moment_;  // nothing: frames are timed by their arrival
  StampClock arrivals_;
  double last_stamp_s_ = 0;
  bool told_arrival_ = false;
};

}  // namespace

std::unique_ptr<Camera> open_v4l2_camera(const Address& address, const CameraSettings& settings,
                                         std::unique_ptr<V4l2Driver> driver, Clock& clock) {
  if (settings.binning.value_or(1) != 1 || settings.trigger != "free") {
    throw Error{Fault::usage, "device '" + address.text + "': V4L2 supports neither binning nor triggers"};
  }
  if (address.place.empty()) {
    throw Error{Fault::usage, "device '" + address.text + "': names no camera; give v4l2:PATH, e.g. v4l2:/dev/video0"};
  }
  return std::make_unique<V4l2Camera>(address, settings, std::move(driver), clock);
}

}  // namespace vam::device
