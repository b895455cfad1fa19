// SPDX-License-Identifier: GPL-3.0-or-later
// One JSON line per event, with UTC and monotonic time, for cron and for a later search for causes.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/text/format_version.hpp"
#include "base/text/json_fwd.hpp"

namespace vam::device {

/// The whole lines of a log up to a byte, and the chain of the last of them.
struct LogEnd {
  std::int64_t bytes = 0;
  std::string chain = {};
};

/// Moves `end` behind the whole lines that follow it in an open file. Returns what is there behind them; none where it
/// cannot be read (errno).
[[nodiscard]] std::optional<std::string> read_on(int fd, LogEnd& end);

/// Appends {"utc": "...", "t_monotonic_s": ..., "event": name, facts...} to the file; the first line that each log adds
/// has the schema, too. A file that is new, or of such lines, is chained (base/log/chain.hpp), whoever else writes to
/// it meanwhile; what a writer that was killed has begun of its line is cut off. "-" is standard error; an empty path
/// logs nothing. Throws Fault::no_output, Fault::io.
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
  /// A line as it is; from any thread.
  void line(const Json& facts);
  /// Several processes may write at once, and no line has a chain.
  void share() { shared_ = true; }
  /// From now on lines are written by a thread of their own, in order: nobody waits for the disk. What cannot be
  /// written is thrown by the next line, or by sync().
  void write_aside();
  /// Shows others by a lock (flock) that somebody writes, until this and all to whom the descriptor that it returns was
  /// given have ended. Throws Fault::busy where another has it, Fault::io.
  [[nodiscard]] int hold() const;
  /// Until now on the disk.
  void sync();
  /// Takes the file away again, if there was none before.
  void undo();

 private:
  void write(const std::vector<std::string>& objects);
  void catch_up();
  void append(const std::vector<std::string>& objects);
  void write_in_order();
  void require_written() const;

  std::string path_;
  FormatKind schema_;
  int fd_ = -1;
  bool made_ = false, versioned_ = false;  // the schema is stated
  bool shared_ = false, chained_ = false;
  bool torn_ = false;  // the file ends within a line, which is none of such a log
  LogEnd end_{-1};     // of the file, as this has left it; -1: not seen yet

  std::mutex access_;
  std::condition_variable changed_;
  std::vector<std::string> pending_;
  std::string problem_;
  bool writing_ = false, ended_ = false;
  std::thread aside_;
};

/// Runs body; what ends it early is logged to that path, {"event": "error", "status": 75, "message": "..."} or
/// {"event": "interrupted", "signal": 15}, when all that body has opened is closed again, and thrown on. A usage
/// error leaves no log where there was none.
void logged(const std::string& path, const std::function<void()>& body);

}  // namespace vam::device
