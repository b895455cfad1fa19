// SPDX-License-Identifier: GPL-3.0-or-later
// Views taken in while the tool computes, so that a camera at the other end of the pipe never waits for a volume.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "io/image/view_source.hpp"

namespace vam::io {

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
