// SPDX-License-Identifier: GPL-3.0-or-later
// Commands that another program carries out: those that are another tool's by now, whose old spelling works for one
// release, and those that are a script.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace vam::tool {

inline std::string own_name(char** argv) {
  const char* slash = std::strrchr(argv[0], '/');
  return slash != nullptr ? slash + 1 : argv[0];
}

/// Becomes `program` with `arguments`, the first of which is its name: that beside the tool's own path, or on PATH.
/// Returns the exit status if it cannot be run.
inline int become(const std::string& self, const std::string& own_path, const std::string& program, char** arguments) {
  const std::size_t folder = own_path.rfind('/');
  if (folder != std::string::npos) execv((own_path.substr(0, folder + 1) + program).c_str(), arguments);
  execvp(program.c_str(), arguments);
  std::cerr << self << ": " << program << ": " << std::strerror(errno) << '\n';
  return static_cast<int>(Fault::no_input);
}

/// When the first argument is `command`: becomes `program` with the arguments that follow it. Returns as become(), -1
/// where it is another.
inline int follow_script(int argc, char** argv, const std::string& command, std::string program) {
  if (argc < 2 || argv[1] != command) return -1;
  const std::string self = own_name(argv);
  argv[1] = program.data();
  return become(self, argv[0], program, argv + 1);
}

/// When the first argument is one of `commands`: reports it on stderr and becomes `now` ("vam-calibrate resin"), with
/// the arguments that follow; the first one stays unless `now` names a command itself. Returns the exit status if that
/// tool cannot be run, else -1.
inline int follow_moved(int argc, char** argv, const std::vector<std::string>& commands, const std::string& now) {
  if (argc < 2 || std::find(commands.begin(), commands.end(), argv[1]) == commands.end()) return -1;
  const auto space = now.find(' ');
  std::string program = now.substr(0, space);
  std::string command = space == std::string::npos ? argv[1] : now.substr(space + 1);
  const std::string self = own_name(argv);
  const std::string own_path = argv[0];
  std::cerr << self << ": warning: " << self << ' ' << argv[1] << " is now " << program << ' ' << command << '\n';
  argv[0] = program.data();
  argv[1] = command.data();
  return become(self, own_path, program, argv);
}

}  // namespace vam::tool
