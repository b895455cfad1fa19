// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/capture.hpp"

#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/text/json.hpp"

namespace vam::device {

namespace {

class FrameSeries {
 public:
  FrameSeries(AngleSource* angles, const CapturePlan& plan, const CaptureSink& sink)
      : angles_(angles), plan_(plan), sink_(sink) {}

  // False when the last place has had its time.
  bool take(CapturedFrame&& frame);
  void flush();
  [[nodiscard]] CaptureTally finish();

 private:
  [[nodiscard]] std::optional<AngleSample> angle_of(const CapturedFrame& frame) const {
    if (angles_ != nullptr) return angles_->at(frame.time_s);
    if (frame.angle_deg) return AngleSample{frame.time_s, *frame.angle_deg, 0};
    return std::nullopt;
  }
  std::optional<long> place_of(const Shot& shot);
  // Is the first a better image of its place than the second?
  [[nodiscard]] bool better(const Shot& one, const Shot& other) const {
    if (one.frame.complete != other.frame.complete) return one.frame.complete;
    const double at_deg = static_cast<double>(one.place) * *plan_.every_deg;
    return std::abs(one.angle->angle_deg - at_deg) < std::abs(other.angle->angle_deg - at_deg);
  }

  AngleSource* angles_;
  const CapturePlan& plan_;
  const CaptureSink& sink_;
  CaptureTally tally_;
  std::optional<long> last_number_;
  std::optional<Shot> waiting_;
  std::optional<long> origin_;  // number of the first frame that counts
  long received_ = 0;
};

// The place of the frame; nothing when it has none.
std::optional<long> FrameSeries::place_of(const Shot& shot) {
  if (plan_.every_deg) {
    if (!shot.angle && angles_ == nullptr) {
      throw Error{Fault::usage, "--view-step: the frames have no angles; give --follow or --speed"};
    }
    if (!shot.angle) return std::nullopt;
    const long place = std::lround(shot.angle->angle_deg / *plan_.every_deg);
    return place < 0 ? std::nullopt : std::optional(place);
  }
  if (angles_ != nullptr && (!shot.angle || shot.angle->angle_deg < 0)) return std::nullopt;
  if (!origin_) origin_ = angles_ == nullptr ? 0 : shot.frame.number;
  return plan_.by_number ? shot.frame.number - *origin_ : received_++;
}

bool FrameSeries::take(CapturedFrame&& frame) {
  if (last_number_ && frame.number > *last_number_ + 1) {
    tally_.dropped += frame.number - *last_number_ - 1;
    sink_.dropped(*last_number_ + 1, frame.number - 1);
  }
  last_number_ = frame.number;
  if (!frame.complete) ++tally_.incomplete;
  const long lost = tally_.dropped + tally_.incomplete;
  if (lost > plan_.max_lost.value_or(lost)) {
    throw Error{Fault::busy, "camera: " + std::to_string(tally_.dropped) + " frames dropped and " +
                                 std::to_string(tally_.incomplete) + " incomplete, at frame " +
                                 std::to_string(frame.number) + "; reduce the frame rate or stop other programs"};
  }
  frame.time_s -= plan_.latency_s;
  Shot shot{std::move(frame), {}, 0};
  shot.angle = angle_of(shot.frame);
  const auto place = place_of(shot);
  if (!place) return true;
  shot.place = *place;
  if (waiting_ && waiting_->place != shot.place) flush();
  if (plan_.frames > 0 && shot.place >= plan_.frames) return false;
  if (!waiting_ || better(shot, *waiting_)) waiting_ = std::move(shot);
  if (plan_.every_deg) return true;  // a better one may come
  const bool last = waiting_->place + 1 == plan_.frames;
  flush();
  return !last;
}

void FrameSeries::flush() {
  if (!waiting_) return;
  Shot shot = std::move(*waiting_);
  waiting_.reset();
  if (!sink_.wanted(shot.place)) return;
  ++tally_.frames;
  sink_.keep(std::move(shot));
}

CaptureTally FrameSeries::finish() {
  flush();
  for (long place = 0; place < plan_.frames; ++place) {
    if (sink_.wanted(place)) ++tally_.missing;
  }
  return tally_;
}

}  // namespace

Json to_json(const CaptureTally& tally) {
  return {{"frames", tally.frames},
          {"dropped", tally.dropped},
          {"incomplete", tally.incomplete},
          {"missing", tally.missing}};
}

CaptureTally capture(Camera& camera, AngleSource* angles, const CapturePlan& plan, const CaptureSink& sink) {
  FrameSeries series(angles, plan, sink);
  if (angles != nullptr) angles->update();
  camera.start();
  for (;;) {
    if (plan.triggered) camera.trigger();
    auto frame = camera.next();
    if (!frame) break;
    if (angles != nullptr) angles->update();
    if (!series.take(std::move(*frame))) break;
  }
  return series.finish();
}

}  // namespace vam::device
