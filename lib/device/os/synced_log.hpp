// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps a log that is being written on the disk, and states how much of it is there.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "base/sha256.hpp"

namespace vam::device {

class EventLog;

/// Brings a log onto the disk, once a second and at the end, from a thread of its own; then appends to another log, if
/// one is given, {"event": "sealed", "log": its name, "bytes": of its whole lines, "sha256": of these}, the first of
/// none, before the disk is waited for. So a log that was cut later, or lost lines, is found out. What is no regular
/// file is left alone. Warns once of a disk that fails.
class SyncedLog {
 public:
  explicit SyncedLog(std::string log, const std::string& seals = "");
  /// After a last time.
  ~SyncedLog();
  SyncedLog(const SyncedLog&) = delete;
  SyncedLog& operator=(const SyncedLog&) = delete;

 private:
  void run();
  bool read_on();
  void keep();
  void seal();
  template <class Step>
  void attempt(const Step& step);
  void warn_once(const std::string& problem);

  std::string path_;
  std::unique_ptr<EventLog> seals_;
  int fd_ = -1;
  std::uint64_t bytes_ = 0;  // of whole lines
  Sha256 hash_;              // of these
  std::string begun_;        // a line that is not whole yet
  bool warned_ = false;
  std::mutex access_;
  std::condition_variable changed_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace vam::device
