// SPDX-License-Identifier: GPL-3.0-or-later
// Keeps logs that are being written on the disk, and states how much of them is there.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "device/os/event_log.hpp"

namespace vam::device {

/// Lets files and the names in folders reach the disk, as far as it can.
void bring_to_disk(const std::vector<std::string>& paths);

/// Brings logs onto the disk, once a second and at the end, from a thread of its own; then states of those that grew,
/// by their names, {"bytes": of their whole lines, "chain": of the last one}. So a log that was cut later, or changed,
/// is found out. What is not there yet, or no regular file, is left alone. Warns once of a disk that fails.
class LogKeeper {
 public:
  using State = std::function<void(const Json& logs)>;
  explicit LogKeeper(const std::vector<std::string>& paths, State state = {});
  /// After a last time.
  ~LogKeeper();
  LogKeeper(const LogKeeper&) = delete;
  LogKeeper& operator=(const LogKeeper&) = delete;

 private:
  struct Log {
    std::string path;
    int fd = -1;
    LogEnd end = {};
    bool grown = false;  // since it was stated
  };
  void run();
  void keep();

  std::vector<Log> logs_;
  State state_;
  bool warned_ = false;
  std::mutex access_;
  std::condition_variable changed_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace vam::device
