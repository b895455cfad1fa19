// SPDX-License-Identifier: GPL-3.0-or-later
// Camera views from wherever they are kept: an EXR frame stack (also a live stream of them), a folder of vam-capture or
// of numbered images, or a video, also read ahead. Frames that a camera delivered in part are left out, each with a
// warning.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/image.hpp"

namespace vam::io {

struct CameraFrame {
  Image image;  // EXR: as stored; images and video: 0...1 of full scale
  double angle_deg = 0;
  double time_s = 0;
  double time_sigma_s = 0;  // shared by the frames of a capture; 0: not known
  std::string name;         // for messages: "views.exr: frame 12"
};

class ViewSource {
 public:
  /// A folder of images and a video know no angles: frame i is taken at i * step_deg, where the images of a folder
  /// count by their numbers from the first one (some may be missing, with a warning); so is a stack without angles of
  /// its own and without an angle step. Throws Error: no_input, data (not a frame stack of a camera), usage (angles are
  /// needed but step_deg is 0).
  ViewSource(const std::string& path, double step_deg);
  ~ViewSource();
  /// False after the last frame; a live stream continues with its next stack by itself.
  bool next(CameraFrame& frame);
  /// Column pitch at the axis by the stack's attribute; 0 without one.
  [[nodiscard]] double pixel_mm() const;
  [[nodiscard]] std::vector<std::string> history() const;

  struct State;

 private:
  std::unique_ptr<State> state_;
};

/// One image or the mean of all images of a stack, for dark and flat fields.
[[nodiscard]] Image read_field(const std::string& path);

/// A thread of its own reads frames into a queue of at most 512 MiB (and 8 frames at least); when it is full the writer
/// waits, so no frame is lost or left out. Destroyed before the end of the source it waits for the frame in progress.
class ViewQueue {
 public:
  explicit ViewQueue(ViewSource& source);
  ~ViewQueue();
  ViewQueue(const ViewQueue&) = delete;
  ViewQueue& operator=(const ViewQueue&) = delete;

  /// The next frame; false after the last. Throws what the source threw, in its turn.
  bool next(CameraFrame& frame);
  /// Frames that wait now.
  [[nodiscard]] int waiting();

 private:
  void read(ViewSource& source);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<CameraFrame> frames_;
  std::exception_ptr failure_;
  bool ended_ = false;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace vam::io
