// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/view_queue.hpp"

#include <algorithm>
#include <utility>

#include "base/index.hpp"

namespace vam::io {

namespace {

std::size_t most_waiting(const CameraFrame& frame) {
  constexpr std::size_t memory = 512U << 20U;
  return std::max<std::size_t>(8, memory / (sizeof(float) * std::max<std::size_t>(1, frame.image.size())));
}

}  // namespace

ViewQueue::ViewQueue(ViewSource& source) : thread_([this, &source] { read(source); }) {}

ViewQueue::~ViewQueue() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void ViewQueue::read(ViewSource& source) {
  try {
    CameraFrame frame;
    while (source.next(frame)) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stop_ || frames_.size() < most_waiting(frame); });
      if (stop_) return;
      frames_.push_back(std::move(frame));
      frame = {};
      changed_.notify_all();
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

bool ViewQueue::next(CameraFrame& frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return ended_ || !frames_.empty(); });
  if (frames_.empty()) {
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return false;
  }
  frame = std::move(frames_.front());
  frames_.pop_front();
  changed_.notify_all();
  return true;
}

int ViewQueue::waiting() {
  const std::lock_guard lock(mutex_);
  return count_of(frames_);
}

}  // namespace vam::io
