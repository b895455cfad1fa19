// SPDX-License-Identifier: GPL-3.0-or-later
// The camera as the tools see it [devices §6]; one backend per file (aravis_camera, v4l2_camera, replay_camera).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/pixels.hpp"
#include "base/text/json_fwd.hpp"
#include "device/camera/stamp.hpp"
#include "device/os/address.hpp"
#include "device/os/clock.hpp"
#include "device/os/lock.hpp"
#include "model/printer.hpp"

namespace vam::device {

/// What is asked of a camera; what is absent stays as the camera has it.
struct CameraSettings {
  std::optional<double> exposure_us;
  std::optional<double> fps;
  std::optional<int> binning;         // both ways
  std::optional<double> gain;         // dB (GenICam) or the camera's own steps (V4L2, GainRaw)
  std::optional<double> black_level;  // in the camera's own unit
  double gamma = 1;                   // intensity to grey level; 1: linear, as every measurement needs it
  std::string stamp = "auto";         // the moment that time stamps name: start, middle, end; auto: as the maker says
  std::string trigger = "free";       // free, software, or the name of an input line
  std::string format;                 // GenICam or V4L2 name of the pixel format; empty: the first grey one
  std::optional<double> timeout_s;

  /// The longest wait for a frame: timeout_s, else a second more than three frame periods and an exposure.
  [[nodiscard]] double patience_s(double period_s) const;
};

/// The camera's mode, read back after setting.
struct CameraMode {
  int columns = 0;
  int rows = 0;
  int bits = 8;            // a pixel has on the wire
  double exposure_us = 0;  // 0: the camera does not say
  double fps = 0;          // 0: the camera does not say
  int binning = 1;
  // Empty: the camera does not say, or has it not.
  std::optional<double> gain, gamma, black_level;
  std::vector<std::string> automatic_off;  // what it has of automatics; all are switched off
};

/// An image with the facts of its taking.
struct CapturedFrame {
  GreyImage levels;                 // 8 or 16 bits; depths between are spread over 16
  long number = 0;                  // frames since start(), including those the camera made that were not received
  double time_s = 0;                // CLOCK_MONOTONIC in the middle of the exposure, but for the camera's lag
  double time_sigma_s = 0;          // standard deviation that times of one capture share; 0: not known
  std::optional<double> device_s;   // the time stamp on the camera's own clock
  bool complete = true;             // false: parts of the image did not arrive and are not of this moment
  std::optional<double> angle_deg;  // as recorded; replay: only
};

/// A source of images. Calls return within their time-out and throw Error: absent (gone), busy (no frame in time),
/// protocol (a setting that does not read back, an image of another size), data (a recorded image of another size),
/// usage (a setting that it does not have). next() throws Interrupted after a signal.
class Camera {
 public:
  virtual ~Camera() = default;
  /// maker, model, serial number, firmware and what else the backend knows: stamp is the moment of an exposure that
  /// time stamps name (start, middle, end), or "arrival", where they are only compared with one another.
  virtual Json identify() = 0;
  [[nodiscard]] virtual CameraMode mode() const = 0;
  virtual void start() = 0;
  /// Takes an image; only with trigger "software".
  virtual void trigger() = 0;
  /// The next frame, in order; nothing when a recording has ended.
  virtual std::optional<CapturedFrame> next() = 0;

  void hold(std::unique_ptr<DeviceLock> lock) { lock_ = std::move(lock); }

 private:
  std::unique_ptr<DeviceLock> lock_;
};

/// The recorded frames of a place, one a call; false after the last.
using CameraFeed = std::function<bool(CapturedFrame&)>;

/// What the backends cannot reach themselves: files, for replay:, and the bench that sim: pretends to look at.
struct CameraBench {
  std::function<CameraFeed(const std::string& place)> open_recording;
  model::Printer printer;
  std::vector<GreyImage> images;  // that the projector shows, by frame index
};

}  // namespace vam::device
