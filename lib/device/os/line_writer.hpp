// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of a log, written by a thread of their own: a disk that is busy must not hold up who drives a device.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace vam::device {

/// Writes all of it. Throws Fault::io, which names the path.
void write_text(int fd, const std::string& text, const std::string& path);

class LineWriter {
 public:
  /// Of a file that stays open as long as this lives.
  LineWriter(int fd, std::string path);
  /// When all is written.
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;
  /// Returns at once. Throws Fault::io when an earlier line could not be written.
  void put(const std::string& text);
  /// Returns when all is written. Throws as put().
  void finish();

 private:
  void run();
  void require_written() const;

  int fd_;
  std::string path_;
  std::mutex access_;
  std::condition_variable changed_;
  std::string pending_;
  std::string problem_;
  bool writing_ = false;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace vam::device
