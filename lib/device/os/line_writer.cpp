// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/line_writer.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <utility>

#include "base/error.hpp"
#include "device/os/process.hpp"

namespace vam::device {

void write_text(int fd, const std::string& text, const std::string& path) {
  for (std::size_t at = 0; at < text.size();) {  // a disk that is just full takes a part, and says why at the rest
    const ssize_t count = write(fd, text.data() + at, text.size() - at);
    if (count < 0) throw Error{Fault::io, path + ": write failed (" + std::strerror(errno) + ")"};
    at += static_cast<std::size_t>(count);
  }
}

LineWriter::LineWriter(int fd, std::string path) : fd_(fd), path_(std::move(path)), thread_([this] { run(); }) {}

LineWriter::~LineWriter() {
  {
    const std::lock_guard lock(access_);
    ended_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LineWriter::put(const std::string& text) {
  {
    const std::lock_guard lock(access_);
    require_written();
    pending_ += text;
  }
  changed_.notify_all();
}

void LineWriter::finish() {
  std::unique_lock lock(access_);
  changed_.wait(lock, [this] { return (pending_.empty() && !writing_) || !problem_.empty(); });
  require_written();
}

void LineWriter::require_written() const {
  if (!problem_.empty()) throw Error{Fault::io, problem_};
}

// As urgent as who drives the device: what is not written yet is lost when the program is killed.
void LineWriter::run() {
  hurry(Urgency::driver);
  std::unique_lock lock(access_);
  for (;;) {
    changed_.wait(lock, [this] { return !pending_.empty() || ended_; });
    if (pending_.empty()) return;
    const std::string text = std::exchange(pending_, {});
    writing_ = true;
    lock.unlock();
    std::string problem;
    try {
      write_text(fd_, text, path_);
    } catch (const std::exception& error) {
      problem = error.what();
    }
    lock.lock();
    writing_ = false;
    if (problem_.empty()) problem_ = problem;
    changed_.notify_all();
    if (!problem_.empty()) return;
  }
}

}  // namespace vam::device
