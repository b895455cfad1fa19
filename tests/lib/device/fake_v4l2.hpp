// SPDX-License-Identifier: GPL-3.0-or-later
// A V4L2 camera behind the system calls that the backend makes, for tests: a counter image, 4 x 2 pixels.
#pragma once

#include <linux/videodev2.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "device/camera/v4l2_driver.hpp"
#include "device/os/clock.hpp"

struct V4l2Script {
  std::vector<std::uint32_t> formats{V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_GREY};
  std::vector<std::uint32_t> sequence{10, 11, 14, 15};  // of the frames to come
  std::uint32_t bad_sequence = 15;                      // arrives with the error flag
  std::uint32_t short_sequence = 99;                    // arrives with half its bytes
  __u32 quantization = V4L2_QUANTIZATION_DEFAULT, colorspace = V4L2_COLORSPACE_DEFAULT;
  __u32 flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;  // of time stamps
  std::optional<__u32> stated_flags;                // before there are frames
  std::vector<double> arrivals_s;                   // host times of the frames; empty: now
  __u32 field = V4L2_FIELD_ANY;                     // any: as requested
  int refuse_open = 0;                              // errno
  int queries = 0;                                  // seen
  bool streams = true;
  int rate_limit = 1000;    // frames a second; faster is not taken
  int rate_errno = 0;       // of setting the rate
  bool hides_rate = false;  // and of reading it
  bool gone = false;        // after the last frame: unplugged, else silent
  bool ended = false;       // likewise, but still there
  int dequeue_errno = 0;    // of the frame after the last
  int exposure = 0;         // seen
  bool exposes = true;      // has an exposure time
  std::map<__u32, int> controls{
      {V4L2_CID_AUTOGAIN, 1}, {V4L2_CID_GAIN, 17}, {V4L2_CID_GAMMA, 220}};  // besides, as it is
  std::set<__u32> stuck;                                                    // take no value
  std::map<__u32, int> refused, unread;                                     // errno of setting, of reading
};

class FakeV4l2 final : public vam::device::V4l2Driver {
 public:
  explicit FakeV4l2(V4l2Script& script, vam::device::Clock& clock) : script_(script), clock_(clock) {}

  int open(const char*) override {
    errno = script_.refuse_open;
    return script_.refuse_open == 0 ? 3 : -1;
  }
  void* map(std::size_t, std::size_t offset) override { return memory_.at(offset).data(); }
  void unmap(void*, std::size_t) override {}
  void close() override {}
  int wait(double seconds) override {
    errno = 0;
    if (next_ < script_.sequence.size() || script_.dequeue_errno != 0) return 1;
    if (script_.gone || script_.ended) return -1;
    clock_.sleep_until(clock_.now_s() + seconds);
    return 0;
  }

  int control(unsigned long request, void* argument) override {
    switch (request) {
      case VIDIOC_QUERYCAP: {
        ++script_.queries;
        if (script_.gone && next_ >= script_.sequence.size()) return fail(ENODEV);
        auto& what = *static_cast<v4l2_capability*>(argument);
        std::strcpy(reinterpret_cast<char*>(what.card), "fake");
        what.capabilities = V4L2_CAP_VIDEO_CAPTURE | (script_.streams ? V4L2_CAP_STREAMING : 0U);
        return 0;
      }
      case VIDIOC_ENUM_FMT: {
        auto& format = *static_cast<v4l2_fmtdesc*>(argument);
        if (format.index >= script_.formats.size()) return fail(EINVAL);
        format.pixelformat = script_.formats[format.index];
        return 0;
      }
      case VIDIOC_G_FMT:
      case VIDIOC_S_FMT: {
        auto& pixels = static_cast<v4l2_format*>(argument)->fmt.pix;
        pixels.width = 4;
        pixels.height = 2;
        deep_ = pixels.pixelformat != V4L2_PIX_FMT_GREY;
        if (script_.field != V4L2_FIELD_ANY) pixels.field = script_.field;
        pixels.quantization = script_.quantization;
        pixels.colorspace = script_.colorspace;
        pixels.bytesperline = deep_ ? 8 : 6;  // padded rows
        return 0;
      }
      case VIDIOC_S_CTRL:
      case VIDIOC_G_CTRL: {
        auto& value = *static_cast<v4l2_control*>(argument);
        const auto& refusals = request == VIDIOC_S_CTRL ? script_.refused : script_.unread;
        if (const auto reason = refusals.find(value.id); reason != refusals.end()) return fail(reason->second);
        if (const auto known = script_.controls.find(value.id); known != script_.controls.end()) {
          if (request == VIDIOC_S_CTRL && !script_.stuck.contains(value.id)) known->second = value.value;
          value.value = known->second;
          return 0;
        }
        if (value.id != V4L2_CID_EXPOSURE_ABSOLUTE || !script_.exposes) return fail(EINVAL);
        (request == VIDIOC_S_CTRL ? script_.exposure : value.value) =
            request == VIDIOC_S_CTRL ? value.value : script_.exposure;
        return 0;
      }
      case VIDIOC_S_PARM:
      case VIDIOC_G_PARM: {
        if (script_.rate_errno != 0 && (request == VIDIOC_S_PARM || script_.hides_rate))
          return fail(script_.rate_errno);
        auto& period = static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe;
        const auto limit = static_cast<__u32>(script_.rate_limit);
        if (request == VIDIOC_G_PARM || period.denominator > limit * period.numerator) period = {1, limit};
        return 0;
      }
      case VIDIOC_REQBUFS:
        static_cast<v4l2_requestbuffers*>(argument)->count = static_cast<__u32>(memory_.size());
        return 0;
      case VIDIOC_QUERYBUF: {
        auto& buffer = *static_cast<v4l2_buffer*>(argument);
        buffer.length = static_cast<__u32>(memory_[0].size());
        buffer.m.offset = buffer.index;
        buffer.flags = script_.stated_flags.value_or(script_.flags);
        return 0;
      }
      case VIDIOC_QBUF:
        queued_.push_back(static_cast<v4l2_buffer*>(argument)->index);
        return 0;
      case VIDIOC_DQBUF:
        return hand_out(*static_cast<v4l2_buffer*>(argument));
      default:
        return 0;
    }
  }

 private:
  static int fail(int reason) {
    errno = reason;
    return -1;
  }
  int hand_out(v4l2_buffer& buffer) {
    if (next_ >= script_.sequence.size()) return fail(script_.dequeue_errno);
    buffer.index = queued_.front();
    queued_.pop_front();
    buffer.sequence = script_.sequence[next_++];
    buffer.bytesused = deep_ ? 16 : 12;
    if (buffer.sequence == script_.short_sequence) buffer.bytesused /= 2;
    auto& bytes = memory_[buffer.index];
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(buffer.sequence + i);
    buffer.flags = script_.flags;
    if (buffer.sequence == script_.bad_sequence) buffer.flags |= V4L2_BUF_FLAG_ERROR;
    buffer.timestamp = {static_cast<long>(buffer.sequence), 500000};
    if (script_.flags == V4L2_BUF_FLAG_TIMESTAMP_COPY) buffer.timestamp = {};
    if (!script_.arrivals_s.empty()) clock_.sleep_until(script_.arrivals_s[next_ - 1]);
    return 0;
  }

  V4l2Script& script_;
  vam::device::Clock& clock_;
  std::array<std::vector<std::uint8_t>, 4> memory_{std::vector<std::uint8_t>(16), std::vector<std::uint8_t>(16),
                                                   std::vector<std::uint8_t>(16), std::vector<std::uint8_t>(16)};
  std::deque<__u32> queued_;
  std::size_t next_ = 0;
  bool deep_ = false;
};
