// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/port/lines.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/error.hpp"

namespace vam::device {

void print_line(const std::string& line) {
  if (std::puts(line.c_str()) < 0 || std::fflush(stdout) != 0) {
    throw Error{Fault::io, std::string("standard output: write failed (") + std::strerror(errno) + ")"};
  }
}

}  // namespace vam::device
