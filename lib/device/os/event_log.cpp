// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/event_log.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <utility>

#include "base/error.hpp"
#include "base/system_error.hpp"
#include "base/text/format_version.hpp"
#include "base/text/json.hpp"
#include "device/os/clock.hpp"
#include "device/os/interrupt.hpp"
#include "device/os/line_writer.hpp"

namespace vam::device {

std::string utc_now(double ago_s) {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  const double back_s = std::ceil(ago_s - 1e-9 * static_cast<double>(now.tv_nsec));
  now.tv_nsec += std::lround(1e9 * (back_s - ago_s));
  now.tv_sec -= static_cast<time_t>(back_s);
  tm parts{};
  gmtime_r(&now.tv_sec, &parts);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  std::array<char, 80> whole{};
  std::snprintf(whole.data(), whole.size(), "%s.%03ldZ", text.data(), now.tv_nsec / 1000000);
  return whole.data();
}

EventLog::EventLog(const std::string& path) : path_(path) {
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
  Json whole{{"utc", utc_now(real_clock().now_s() - t_s)}, {"t_monotonic_s", t_s}, {"event", event}};
  whole.update(facts);
  line(whole);
}

void EventLog::line(const Json& facts) {
  if (fd_ < 0) return;
  Json whole = facts;
  if (!versioned_.test_and_set()) whole["schema"] = FormatKind("vam-log").schema();
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
