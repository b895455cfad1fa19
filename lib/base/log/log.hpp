// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings and notes on standard error; standard output is for data, and success is silent.
#pragma once

#include <string>

namespace vam {

/// The name that begins every line on stderr ("vam-slice: ..."); set once by cli::App.
void set_program_name(const std::string& name);
[[nodiscard]] const std::string& program_name();

enum class ProgressStyle : int { line, json, none };

/// What is said beside errors.
struct LogOptions {
  bool quiet = false;                            // nothing
  bool verbose = false;                          // notes also where stderr is no terminal; what each task took
  ProgressStyle progress = ProgressStyle::line;  // of base/log/progress.hpp
};
/// Set once by cli::App, before there are threads.
void set_talk(const LogOptions& talk);
[[nodiscard]] const LogOptions& talk();

/// "<program>: <line>" on stderr, whatever the settings.
void say(const std::string& line);

/// One line on stderr: "<program>: warning: <line>", unless quiet.
void warn(const std::string& line);

/// One line on stderr, only when that is a terminal or verbose: a summary for the user.
void note(const std::string& line);

}  // namespace vam
