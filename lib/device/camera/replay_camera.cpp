// SPDX-License-Identifier: GPL-3.0-or-later
// A recording as a camera: the same frames again, as fast as they can be read or in step with the recorded times.
#include <utility>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "device/camera/camera_backends.hpp"

namespace vam::device {

namespace {

class ReplayCamera final : public Camera {
 public:
  ReplayCamera(const std::string& place, bool in_step, const CameraBench& bench, Clock& clock)
      : place_(place), in_step_(in_step), clock_(clock), feed_(bench.open_recording(place)) {
    if (!feed_(first_)) throw Error{Fault::data, place + ": the recording has no frames"};
    mode_.columns = first_.levels.width;
    mode_.rows = first_.levels.height;
    mode_.bits = first_.levels.bits;
    waiting_ = true;
  }

  Json identify() override { return {{"maker", "vam"}, {"model", "recording"}, {"serial", place_}}; }
  CameraMode mode() const override { return mode_; }
  void start() override { start_s_ = clock_.now_s(); }
  void trigger() override { throw Error{Fault::usage, place_ + ": a recording cannot be triggered"}; }

  std::optional<CapturedFrame> next() override {
    CapturedFrame frame;
    if (std::exchange(waiting_, false)) {
      frame = std::move(first_);
      origin_s_ = frame.time_s;
    } else if (!feed_(frame)) {
      return std::nullopt;
    }
    if (const auto other = another_size(mode_, frame.levels.width, frame.levels.height)) {
      throw Error{Fault::data, place_ + ": frame " + std::to_string(frame.number) + " has " + *other};
    }
    if (in_step_) {
      frame.time_s += start_s_ - origin_s_;
      clock_.sleep_until(frame.time_s);
    } else {
      clock_.sleep_until(0);  // a signal ends this, too
    }
    return frame;
  }

 private:
  std::string place_;
  bool in_step_;
  Clock& clock_;
  CameraFeed feed_;
  CapturedFrame first_;
  CameraMode mode_;
  bool waiting_ = false;
  double start_s_ = 0;
  double origin_s_ = 0;
};

}  // namespace

std::unique_ptr<Camera> open_replay_camera(const Address& address, const CameraSettings&, const CameraBench& bench,
                                           Clock& clock) {
  return std::make_unique<ReplayCamera>(address.place, in_real_pace(address, "virtual"), bench, clock);
}

}  // namespace vam::device
