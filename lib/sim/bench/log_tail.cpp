// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/bench/log_tail.hpp"

#include <sys/stat.h>

#include <array>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"

namespace vam::sim {

bool LogTail::replaced() const {
  struct stat read = {};
  struct stat named = {};
  return fstat(fileno(file_.get()), &read) == 0 && stat(path_.c_str(), &named) == 0 &&
         (read.st_ino != named.st_ino || read.st_dev != named.st_dev);
}

void LogTail::read_on(std::vector<Json>& lines) {
  std::clearerr(file_.get());  // past the end of the file that there was
  std::array<char, 4096> piece;
  while (std::fgets(piece.data(), piece.size(), file_.get())) {
    rest_ += piece.data();
    if (!rest_.ends_with('\n')) continue;  // or a zero byte, as a fault of the disk leaves them
    Json event = parse_json(rest_);
    if (event.is_object()) {
      const std::string why = schema_objection(text_at(event, "schema"));
      if (!why.empty()) throw Error{Fault::data, path_ + ": " + why};
      lines.push_back(std::move(event));
    }
    rest_.clear();
  }
}

std::vector<Json> LogTail::fresh() {
  std::vector<Json> lines;
  if (path_.empty()) return lines;
  if (file_) {
    const bool old = replaced();  // asked first: what was added before is read to the end
    read_on(lines);
    if (!old) return lines;
    rest_.clear();
  }
  file_.reset(std::fopen(path_.c_str(), "re"));
  if (file_) read_on(lines);
  return lines;
}

}  // namespace vam::sim
