// Commands that are another tool's by now: the old spelling works for one release.
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

/// When the first argument is one of `commands`: reports it on stderr and becomes `now` ("vam-calibrate resin"), with
/// the arguments that follow; the first one stays unless `now` names a command itself. Returns the exit status if that
/// tool cannot be run, else -1.
inline int follow_moved(int argc, char** argv, const std::vector<std::string>& commands, const std::string& now) {
  if (argc < 2 || std::find(commands.begin(), commands.end(), argv[1]) == commands.end()) return -1;
  const auto space = now.find(' ');
  std::string program = now.substr(0, space);
  std::string command = space == std::string::npos ? argv[1] : now.substr(space + 1);
  const char* slash = std::strrchr(argv[0], '/');
  const std::string self = slash != nullptr ? slash + 1 : argv[0];
  std::cerr << self << ": warning: " << self << ' ' << argv[1] << " is now " << program << ' ' << command << '\n';
  argv[0] = program.data();
  argv[1] = command.data();
  execvp(program.c_str(), argv);
  std::cerr << self << ": " << program << ": " << std::strerror(errno) << '\n';
  return static_cast<int>(Fault::no_input);
}

}  // namespace vam::tool
