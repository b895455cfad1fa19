// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/view_source.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "io/exr/stack.hpp"
#include "io/image/capture_folder.hpp"
#include "io/image/image_file.hpp"
#include "io/image/video.hpp"

namespace vam::io {

namespace {

bool is_video(const std::string& path) {
  return path.ends_with(".mkv") || path.ends_with(".mp4") || path.ends_with(".avi");
}

}  // namespace

struct ViewSource::State {
  std::string path;
  double step_deg = 0;
  int index = 0;
  std::unique_ptr<StackReader> stack;
  std::unique_ptr<ImageFolder> folder;
  std::unique_ptr<VideoReader> video;
  std::optional<CaptureManifest> capture;
  std::map<long, CaptureRecord>::const_iterator recorded;

  // What came in part is no view.
  void leave_out(const std::string& name) { warn(name + ": was received incomplete from the camera and is skipped"); }

  bool next_of_stack(CameraFrame& frame) {
    model::ImageInfo about;
    do {
      while (!stack->next(frame.image, about)) {
        if (!stack->next_stack()) return false;
      }
      if (about.incomplete) leave_out(path + ": frame " + std::to_string(about.number));
    } while (about.incomplete);
    if (about.has_time) frame.time_s = about.time_s;
    frame.time_sigma_s = about.time_sigma_s;
    const bool known = about.has_angle || stack->info().angle_step_deg != 0;
    frame.angle_deg = known ? about.angle_deg : index * needed_step();
    return true;
  }

  bool next_of_capture(CameraFrame& frame) {
    while (recorded != capture->frames.end() && !recorded->second.complete) {
      leave_out(path + "/" + capture_file_name(recorded++->first));
    }
    if (recorded == capture->frames.end()) return false;
    const CaptureRecord& record = recorded++->second;
    frame.name = path + "/" + capture_file_name(record.place);
    frame.image = fractions(read_captured(path, record));
    frame.time_s = record.t_monotonic_s;
    frame.time_sigma_s = record.time_sigma_s.value_or(0);
    frame.angle_deg = record.angle_deg ? *record.angle_deg : static_cast<double>(record.place) * needed_step();
    return true;
  }

  [[nodiscard]] double needed_step() const {
    if (step_deg == 0)
      throw Error{Fault::usage, path + ": the frames have no angles; give their angular step by --view-step"};
    return step_deg;
  }
};

ViewSource::ViewSource(const std::string& path, double step_deg) : state_(std::make_unique<State>()) {
  state_->path = path;
  state_->step_deg = step_deg;
  if (path != "-" && is_capture_folder(path)) {
    state_->capture = open_capture(path);
    state_->recorded = state_->capture->frames.begin();
  } else if (path != "-" && std::filesystem::is_directory(path)) {
    state_->folder = std::make_unique<ImageFolder>(path, true);
    (void)state_->needed_step();
    const ImageFolder& folder = *state_->folder;
    const long missing = folder.place(folder.count() - 1) + 1 - folder.count();
    if (missing > 0) {
      warn(path + ": " + std::to_string(missing) + (missing == 1 ? " number is" : " numbers are") +
           " missing between the first and the last; the others keep their angles");
    }
    // Programs number from 0 or 1, and cameras from any number, but rarely a small one.
    if (const long first = folder.first_number(); first > 1 && first < 10) {
      warn(path + ": numbers begin at " + std::to_string(first) +
           ", which is taken for angle 0; if earlier images are missing, all angles are too small");
    }
  } else if (is_video(path)) {
    state_->video = std::make_unique<VideoReader>(path);
    (void)state_->needed_step();
  } else {
    state_->stack = std::make_unique<StackReader>(path, true);
    require(path, state_->stack->info(), model::Kind::frames, model::Space::camera);
  }
}

ViewSource::~ViewSource() = default;

bool ViewSource::next(CameraFrame& frame) {
  State& s = *state_;
  frame.name = s.path + ": frame " + std::to_string(s.index);
  if (s.capture) {
    if (!s.next_of_capture(frame)) return false;
  } else if (s.stack) {
    if (!s.next_of_stack(frame)) return false;
  } else if (s.folder) {
    if (s.index >= s.folder->count()) return false;
    frame.name = s.folder->path(s.index);
    frame.image = fractions(s.folder->read(s.index));
    frame.angle_deg = static_cast<double>(s.folder->place(s.index)) * s.step_deg;
  } else {
    GreyImage grey;
    if (!s.video->next(grey)) return false;
    frame.image = fractions(grey);
    frame.angle_deg = s.index * s.step_deg;
  }
  ++s.index;
  return true;
}

double ViewSource::pixel_mm() const {
  if (state_->capture) return number_at(Json::parse(state_->capture->head), "pixel_mm");
  return state_->stack ? state_->stack->info().pixel_mm : 0;
}

std::vector<std::string> ViewSource::history() const {
  return state_->stack ? state_->stack->info().history : std::vector<std::string>{};
}

Image read_field(const std::string& path) {
  if (is_image_file(path)) return fractions(read_image(path));
  StackReader reader(path);
  Image sum;
  Image image;
  model::ImageInfo about;
  int count = 0;
  for (; reader.next(image, about); ++count) {
    if (count == 0) {
      sum = image;
      continue;
    }
    for (std::size_t i = 0; i < sum.size(); ++i) sum.values[i] += image.values[i];
  }
  for (float& value : sum.values) value /= static_cast<float>(count);
  return sum;
}

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
