// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/event_log.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <utility>

#include "base/error.hpp"
#include "base/log/chain.hpp"
#include "base/system_error.hpp"
#include "base/text/json.hpp"
#include "base/text/utc.hpp"
#include "device/os/clock.hpp"
#include "device/os/interrupt.hpp"
#include "device/os/process.hpp"

namespace vam::device {

namespace {

/// Programs that write to a log take turns, but nobody waits for long: a chain that is broken is found out, light that
/// stays on is not.
class Turn {
 public:
  explicit Turn(int log) : log_(log) {
    constexpr int tries = 1000;
    constexpr useconds_t pause_us = 1000;
    for (int i = 0; i < tries && !(taken_ = set(F_WRLCK)) && errno == EAGAIN; ++i) usleep(pause_us);
  }
  ~Turn() {
    if (taken_) (void)set(F_UNLCK);
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  [[nodiscard]] bool set(short type) const {
    struct flock whole = {};
    whole.l_whence = SEEK_SET;
    whole.l_type = type;
    return fcntl(log_, F_OFD_SETLK, &whole) == 0;
  }
  int log_;
  bool taken_ = false;
};

}  // namespace

std::optional<std::string> read_on(int fd, LogEnd& end) {
  std::string more;
  std::array<char, 65536> room{};
  for (ssize_t count = 1; count > 0; more.append(room.data(), static_cast<std::size_t>(count))) {
    count = pread(fd, room.data(), room.size(), end.bytes + std::ssize(more));
    if (count < 0) return std::nullopt;
  }
  const std::size_t whole = more.rfind('\n') + 1;  // npos + 1: none
  if (whole == 0) return more;
  const std::string lines = more.substr(0, whole - 1);
  end = {end.bytes + static_cast<std::int64_t>(whole), chain_of(lines.substr(lines.rfind('\n') + 1))};
  return more.substr(whole);
}

EventLog::EventLog(const std::string& path, FormatKind schema) : path_(path), schema_(schema) {
  if (path.empty()) return;
  const auto opened = [&](int more) {
    return open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | more, 0644);
  };
  if (path == "-") {
    fd_ = dup(STDERR_FILENO);
  } else if (fd_ = opened(O_EXCL); fd_ >= 0) {
    made_ = true;
  } else {
    fd_ = opened(0);
  }
  if (fd_ < 0) throw system_error(Fault::no_output, path + ": cannot be written", errno);
}

EventLog::~EventLog() {
  if (aside_.joinable()) {
    {
      const std::lock_guard lock(access_);
      ended_ = true;
    }
    changed_.notify_all();
    aside_.join();
  }
  if (fd_ >= 0) close(fd_);
}

void EventLog::operator()(const std::string& event) { (*this)(event, Json::object()); }

void EventLog::operator()(const std::string& event, const Json& facts) { at(real_clock().now_s(), event, facts); }

void EventLog::at(double t_s, const std::string& event, const Json& facts) {
  if (fd_ < 0) return;
  Json whole{{"utc", utc_text(utc_seconds() - (real_clock().now_s() - t_s))}, {"t_monotonic_s", t_s}, {"event", event}};
  whole.update(facts);
  line(whole);
}

void EventLog::line(const Json& facts) {
  if (fd_ < 0) return;
  const std::lock_guard lock(access_);
  require_written();
  Json whole = facts;
  if (!std::exchange(versioned_, true)) whole["schema"] = schema_.schema();
  // Bytes that a device made up need not be UTF-8.
  const std::string text = whole.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (!aside_.joinable()) return write({text});
  pending_.push_back(text);
  changed_.notify_all();
}

void EventLog::write(const std::vector<std::string>& objects) {
  if (shared_) return append(objects);
  const Turn turn(fd_);
  catch_up();
  append(objects);
}

void EventLog::append(const std::vector<std::string>& objects) {
  std::string text = std::exchange(torn_, false) ? "\n" : "";
  std::string chain = end_.chain;  // which is that of the last line that was written
  for (const std::string& object : objects) text += (chained_ ? chained(object, chain) : object) + "\n";
  for (std::size_t at = 0; at < text.size();) {  // a disk that is just full takes a part, and says why at the rest
    const ssize_t count = ::write(fd_, text.data() + at, text.size() - at);
    if (count < 0) throw Error{Fault::io, path_ + ": write failed (" + std::strerror(errno) + ")"};
    at += static_cast<std::size_t>(count);
  }
  end_ = {end_.bytes + std::ssize(text), chain};
}

// With what others have added, as a part of this process that ended, or one that was killed.
void EventLog::catch_up() {
  struct stat about = {};
  if (path_ == "-" || fstat(fd_, &about) != 0 || !S_ISREG(about.st_mode) || about.st_size == end_.bytes) return;
  constexpr off_t longest = 1 << 20;  // line that is read
  if (end_.bytes < 0 || end_.bytes > about.st_size) end_ = {std::max<off_t>(0, about.st_size - longest)};
  const int reader = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  const auto rest = read_on(reader, end_);
  const int problem = errno;
  if (reader >= 0) close(reader);
  if (!rest) throw system_error(Fault::io, path_ + ": cannot be read on", problem);
  chained_ = about.st_size == 0 || !end_.chain.empty();
  torn_ = !rest->empty() && !chained_;
  if (torn_) end_.bytes += std::ssize(*rest);  // what is not such a log is only added to
  if (rest->empty() || torn_) return;
  if (ftruncate(fd_, end_.bytes) != 0) throw system_error(Fault::io, path_ + ": cannot be written", errno);
}

void EventLog::write_aside() {
  if (fd_ >= 0 && !aside_.joinable()) aside_ = std::thread([this] { write_in_order(); });
}

// As urgent as who drives the device: what is not written yet is lost when the program is killed.
void EventLog::write_in_order() {
  hurry(Urgency::driver);
  std::unique_lock lock(access_);
  while (problem_.empty()) {
    changed_.wait(lock, [this] { return !pending_.empty() || ended_; });
    if (pending_.empty()) return;
    const std::vector<std::string> objects = std::exchange(pending_, {});
    writing_ = true;
    lock.unlock();
    std::string problem;
    try {
      write(objects);
    } catch (const std::exception& error) {
      problem = error.what();
    }
    lock.lock();
    writing_ = false;
    problem_ = problem;
    changed_.notify_all();
  }
}

void EventLog::require_written() const {
  if (!problem_.empty()) throw Error{Fault::io, problem_};
}

void EventLog::sync() {
  std::unique_lock lock(access_);
  changed_.wait(lock, [this] { return (pending_.empty() && !writing_) || !problem_.empty(); });
  require_written();
  lock.unlock();  // others do not wait for the disk
  if (fd_ >= 0) fdatasync(fd_);
}

int EventLog::hold() const {
  constexpr int beyond_redirections = 10;
  const int opened = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (opened < 0) throw system_error(Fault::io, path_ + ": cannot be locked", errno);
  const int held = fcntl(opened, F_DUPFD_CLOEXEC, beyond_redirections);
  close(opened);
  if (flock(held, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw Error{Fault::busy, path_ + ": is in use by another program"};
  return held;
}

void EventLog::undo() {
  if (std::exchange(made_, false)) unlink(path_.c_str());
}

void logged(const std::string& path, const std::function<void()>& body) {
  EventLog log(path);
  const auto note = [&](const char* event, const Json& facts) {
    try {
      log(event, facts);
    } catch (const Error&) {
      // A disk that is full may be the very cause; that is what to report.
    }
  };
  try {
    body();
  } catch (const Error& error) {
    if (error.fault == Fault::usage) log.undo();
    note("error", {{"status", static_cast<int>(error.fault)}, {"message", error.what()}});
    throw;
  } catch (const Interrupted& interrupted) {
    note("interrupted", {{"signal", interrupted.signal}});
    throw;
  }
}

}  // namespace vam::device
