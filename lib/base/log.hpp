// Warnings, notes and progress on standard error; standard output is for data, and success is silent.
#pragma once

#include <atomic>
#include <chrono>
#include <string>

namespace vam {

/// The name that begins every line on stderr ("vam-slice: ..."); set once by cli::App.
void set_program_name(const std::string& name);

/// One line on stderr: "<program>: warning: <line>".
void warn(const std::string& line);

/// One line on stderr, only when stderr is a terminal: a summary for the user.
void note(const std::string& line);

/// A progress bar on stderr, only when stderr is a terminal and the work lasts longer than half a second.
/// tick() may be called from any thread.
class Progress {
 public:
  Progress(std::string what, long total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void tick(long steps = 1);

 private:
  void draw(long done);
  std::string what_;
  long total_;
  bool terminal_;
  std::atomic<long> done_{0};
  std::atomic<long> drawn_ms_{0};
  std::chrono::steady_clock::time_point start_;
};

}  // namespace vam
