// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/json_log.hpp"

#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "base/system_error.hpp"

namespace vam::io {

void CloseFile::operator()(std::FILE* file) const {
  if (file != stderr) std::fclose(file);
}

JsonLog open_log(const std::string& path) {
  if (path.empty()) return nullptr;
  if (path == "-") return JsonLog(stderr);
  JsonLog log(std::fopen(path.c_str(), "ae"));
  if (!log) throw system_error(Fault::no_output, path + ": cannot append", errno);
  return log;
}

void log_line(std::FILE& log, const std::string& line) {
  errno = 0;
  if (std::fputs((line + "\n").c_str(), &log) < 0 || std::fflush(&log) != 0) {
    throw Error{Fault::io, std::string("log: write failed (") + std::strerror(errno) + ")"};
  }
}

}  // namespace vam::io
