// SPDX-License-Identifier: GPL-3.0-or-later
// Tools as processes of another: their command lines, what they are connected to, what they say, how they end.
#pragma once

#include <sys/types.h>

#include <csignal>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace vam::device {

/// Opened by the new process itself, so that a named pipe waits for its other end there.
struct Redirection {
  int descriptor;
  std::string path;
  int flags;
};

/// What runs by hand as well.
struct Command {
  std::string name;  // in records and messages: project, stage, ...
  std::vector<std::string> words;
  std::vector<Redirection> files = {};  // in this order; what is not redirected is /dev/null
};

/// Who is told by the kernel, and what a process has of vam-print.
struct Manner {
  bool with_parent = false;  // ends (SIGTERM) with this process; the tools know how to do so themselves
  bool nice = false;
  bool undisturbed = false;  // by INT, TERM and HUP
  int shared = -1;           // a descriptor that it keeps open
  bool on_terminal = false;  // standard error is this process's
};

/// To be called by who runs tools before the first: neither ^Z nor a reader of its messages that ends stops it, as it
/// would watch over nobody, and it is told how the tools end.
void supervise();

/// A child of this process, which orders its end; in a process group of its own, so that no terminal does.
class Child {
 public:
  /// standard error is appended to the file `said`. Throws Fault::memory where no process can be made.
  Child(const Command& command, const std::string& said, const Manner& manner);
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] pid_t pid() const { return pid_; }
  /// Readable once it has ended, also for who is not its parent.
  [[nodiscard]] int handle() const { return handle_; }
  /// True when it has ended within that time, in ms; -1: for ever.
  [[nodiscard]] bool ends_within(int limit_ms) const;
  void order(int signal) const { ::kill(pid_, signal); }
  /// Waits; the status as a shell has it: 128 and the signal. limit_ms: kills it then.
  int status(int limit_ms = -1);

 private:
  std::string name_;
  pid_t pid_ = -1;
  int handle_ = -1;
};

/// Until one of them has ended, or that time is over (-1: never). Throws device::Interrupted when a signal came.
void wait_for_an_end(const std::vector<Child>& children, int limit_ms);

/// Runs a command to its end, which is ordered after limit_ms (-1: never), and returns its status, then `timed_out`;
/// throws device::Interrupted when a signal came meanwhile, which is passed on.
int run_to_end(const Command& command, const std::string& said, int limit_ms = -1);
inline constexpr int timed_out = 124;  // as of timeout(1)

/// What the tools say on standard error, in memory without a name: the disk of the run may be full.
class Talk {
 public:
  Talk() = default;
  ~Talk();
  Talk(const Talk&) = delete;
  Talk& operator=(const Talk&) = delete;

  /// The file of what a tool says, for this process and until it becomes another, its children. Throws Fault::memory.
  [[nodiscard]] std::string path(const std::string& tool) const;
  [[nodiscard]] std::string text(const std::string& tool) const;
  void add(const std::string& tool, const std::string& line) const;
  void forget(const std::string& tool) const;
  void forget() const;
  /// Shows of the lines that a tool said those that count; all without `counts`.
  void show(const std::string& tool, const std::function<bool(const std::string&)>& counts = {}) const;
  /// Into a run folder.
  void keep(const std::string& run) const;

 private:
  mutable std::map<std::string, int> files_;
};

/// Orders them all to end, and kills who has not after 2 s; `ended` is told of each, with its status.
void end_all(std::vector<Child>& children, const std::function<void(Child& child, int status)>& ended);

/// Runs vam-devices off with this printer file and light engine (empty: none): what it says of each device, in a line.
[[nodiscard]] std::string switch_off(const Talk& talk, const std::string& printer, const std::string& light);

/// A folder of its own in $TMPDIR, else /tmp, which goes with all in it. Throws Fault::no_output.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The whole of a small file; empty where there is none.
[[nodiscard]] std::string text_of(const std::string& path);

/// The last line, without its end.
[[nodiscard]] std::string last_line(const std::string& text);

/// A line that has the name of its tool already.
void pass_on(const std::string& line);

}  // namespace vam::device
