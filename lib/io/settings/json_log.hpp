// SPDX-License-Identifier: GPL-3.0-or-later
// Logs that grow while a tool runs: one line of JSON per event, on the disk before the next one.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace vam::io {

struct CloseFile {
  void operator()(std::FILE* file) const;
};
using JsonLog = std::unique_ptr<std::FILE, CloseFile>;

/// Appends to `path`; "-" is stderr; empty: no log. Throws Fault::no_output.
[[nodiscard]] JsonLog open_log(const std::string& path);

/// Writes the line and flushes it. Throws Fault::io.
void log_line(std::FILE& log, const std::string& line);

}  // namespace vam::io
