#include "device/event_log.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "base/error.hpp"
#include "device/clock.hpp"

namespace vam::device {

std::string utc_now() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
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
  fd_ = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (fd_ < 0) throw Error{Fault::no_output, path + ": cannot be written (" + std::strerror(errno) + ")"};
}

EventLog::~EventLog() {
  if (fd_ >= 0) close(fd_);
}

void EventLog::operator()(const std::string& event, const Json& facts) {
  if (fd_ < 0) return;
  Json whole{{"utc", utc_now()}, {"t_monotonic_s", real_clock().now_s()}, {"event", event}};
  whole.update(facts);
  line(whole);
}

void EventLog::line(const Json& facts) {
  if (fd_ < 0) return;
  // Bytes that a device made up need not be UTF-8.
  const std::string text = facts.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  if (write(fd_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw Error{Fault::io, path_ + ": write failed (" + std::strerror(errno) + ")"};
  }
}

void EventLog::sync() {
  if (fd_ >= 0) fdatasync(fd_);
}

}  // namespace vam::device
