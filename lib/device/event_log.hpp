// One JSON line per event, with UTC and monotonic time, for cron and for whoever looks for the cause afterwards.
#pragma once

#include <cstdio>
#include <string>

#include "base/json.hpp"

namespace vam::device {

/// Appends {"utc": "...", "t_monotonic_s": ..., "event": name, facts...} to the file, one write a line, so that several
/// processes may share it. An empty path logs nothing. Throws Fault::no_output, Fault::io.
class EventLog {
 public:
  explicit EventLog(const std::string& path);
  ~EventLog();
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;
  void operator()(const std::string& event, const Json& facts = Json::object());
  /// A line as it is, for those who know their own time.
  void line(const Json& facts);
  /// Until now on the disk.
  void sync();

 private:
  std::string path_;
  int fd_ = -1;
};

/// "2026-11-21T04:43:00.123Z"
[[nodiscard]] std::string utc_now();

}  // namespace vam::device
