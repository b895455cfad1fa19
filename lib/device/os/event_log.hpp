// SPDX-License-Identifier: GPL-3.0-or-later
// One JSON line per event, with UTC and monotonic time, for cron and for a later search for causes.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "base/text/format_version.hpp"
#include "base/text/json_fwd.hpp"

namespace vam::device {

class LineWriter;

/// Appends {"utc": "...", "t_monotonic_s": ..., "event": name, facts...} to the file, one write a line, so that several
/// processes may share it; the first line that each adds has the schema, too. "-" is standard error; an empty path logs
/// nothing. Throws Fault::no_output, Fault::io.
class EventLog {
 public:
  explicit EventLog(const std::string& path, FormatKind schema = "vam-log");
  ~EventLog();
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;
  void operator()(const std::string& event);
  void operator()(const std::string& event, const Json& facts);
  /// What happened at a time of its own, on CLOCK_MONOTONIC.
  void at(double t_s, const std::string& event, const Json& facts);
  /// A line as it is.
  void line(const Json& facts);
  /// From now on lines are written by a thread of their own, in order: nobody waits for the disk. What cannot be
  /// written is thrown by the next line, or by sync().
  void write_aside();
  /// Until now on the disk.
  void sync();
  /// Takes the file away again, if there was none before.
  void undo();

 private:
  std::string path_;
  FormatKind schema_;
  int fd_ = -1;
  bool made_ = false;
  std::atomic_flag versioned_;  // the schema is stated
  std::unique_ptr<LineWriter> writer_;
};

/// Runs body; what ends it early is logged to that path, {"event": "error", "status": 75, "message": "..."} or
/// {"event": "interrupted", "signal": 15}, when all that body has opened is closed again, and thrown on. A usage
/// error leaves no log where there was none.
void logged(const std::string& path, const std::function<void()>& body);

}  // namespace vam::device
