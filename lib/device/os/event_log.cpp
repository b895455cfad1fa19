// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/event_log.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "base/error.hpp"
#include "base/system_error.hpp"
#include "base/text/json.hpp"
#include "base/text/utc.hpp"
#include "device/os/clock.hpp"
#include "device/os/interrupt.hpp"
#include "device/os/line_writer.hpp"

namespace vam::device {

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
  writer_.reset();
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
  Json whole = facts;
  if (!versioned_.test_and_set()) whole["schema"] = schema_.schema();
  // Bytes that a device made up need not be UTF-8.
  const std::string text = whole.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  if (writer_) return writer_->put(text);
  write_text(fd_, text, path_);
}

void EventLog::write_aside() {
  if (fd_ >= 0 && !writer_) writer_ = std::make_unique<LineWriter>(fd_, path_);
}

void EventLog::sync() {
  if (writer_) writer_->finish();
  if (fd_ >= 0) fdatasync(fd_);
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
