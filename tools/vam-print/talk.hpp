// SPDX-License-Identifier: GPL-3.0-or-later
// What the tools say, kept in memory: the disk of the run may be full.
#pragma once

#include <functional>
#include <string>

namespace vam::print_tool {

/// A folder in /dev/shm, else in $TMPDIR, that is gone with this process; those of processes that were killed go first.
class Talk {
 public:
  /// Throws Fault::no_output.
  Talk();
  ~Talk();
  Talk(const Talk&) = delete;
  Talk& operator=(const Talk&) = delete;

  [[nodiscard]] const std::string& folder() const { return folder_; }
  /// The file of what a tool says on standard error.
  [[nodiscard]] std::string path(const std::string& tool) const;
  [[nodiscard]] std::string text(const std::string& tool) const;
  void add(const std::string& tool, const std::string& line) const;
  void forget(const std::string& tool) const;
  void forget() const;
  /// Shows what a tool said, each line as it is; or of its lines those that count.
  void show(const std::string& tool) const;
  void show(const std::string& tool, const std::function<bool(const std::string&)>& counts) const;
  /// Into a run folder.
  void keep(const std::string& run) const;

 private:
  std::string folder_;
};

/// The whole of a small file; empty where there is none.
[[nodiscard]] std::string text_of(const std::string& path);

/// The last line, without its end.
[[nodiscard]] std::string last_line(const std::string& text);

/// A line that has the name of its tool already.
void pass_on(const std::string& line);

}  // namespace vam::print_tool
