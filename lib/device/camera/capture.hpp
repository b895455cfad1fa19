// SPDX-License-Identifier: GPL-3.0-or-later
// Taking a series of frames: which of them are kept, at what angle, and what was lost.
#pragma once

#include <functional>
#include <optional>

#include "base/text/json_fwd.hpp"
#include "device/camera/camera.hpp"
#include "device/stage/angle_source.hpp"

namespace vam::device {

struct CapturePlan {
  bool triggered = false;           // each frame is asked for (trigger "software")
  long frames = 0;                  // places to fill; 0: without end
  std::optional<double> every_deg;  // a place is an angle, k * every_deg
  bool by_number = false;           // without every_deg: a place is a frame number, else the n-th frame received
  std::optional<long> max_lost;     // give up when more are dropped or incomplete
  double latency_s = 0;             // from the middle of an exposure to the camera's time stamp, calibrated
};

/// A frame that is kept.
struct Shot {
  CapturedFrame frame;  // time_s is the middle of the exposure
  std::optional<AngleSample> angle;
  long place = 0;
};

struct CaptureTally {
  long frames = 0;      // kept, incomplete ones included
  long dropped = 0;     // made by the camera and never received
  long incomplete = 0;  // received in part
  long missing = 0;     // places that no frame was taken for
};
[[nodiscard]] Json to_json(const CaptureTally& tally);

struct CaptureSink {
  std::function<bool(long place)> wanted;              // is it not there yet?
  std::function<void(Shot&& shot)> keep;               // in ascending order of place
  std::function<void(long first, long last)> dropped;  // frame numbers
};

/// Starts the camera and takes frames until every place up to plan.frames had its time, or a recording ends. With
/// every_deg the frame nearest to the place's angle is kept, a complete one rather than an incomplete one. Frames
/// before angle 0 and before angles are known are left out. angles may be null: then the recorded ones, if any, count.
/// Throws what camera, angles and sink throw, Fault::usage when angles are needed and there are none, and Fault::busy
/// when too many frames are lost.
CaptureTally capture(Camera& camera, AngleSource* angles, const CapturePlan& plan, const CaptureSink& sink);

}  // namespace vam::device
