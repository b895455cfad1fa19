// SPDX-License-Identifier: GPL-3.0-or-later
// The end of a log that another program writes meanwhile.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/text/json_fwd.hpp"

namespace vam::sim {

/// The lines that have come to a log since the last look; a log that does not exist yet has none. Where a new file has
/// taken its name, as when a run begins again in the same folder, the old one's last lines come first, then the new
/// one's. Throws Fault::data for lines of a version that is not read.
class LogTail {
 public:
  explicit LogTail(std::string path) : path_(std::move(path)) {}
  std::vector<Json> fresh();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[nodiscard]] bool replaced() const;
  void read_on(std::vector<Json>& lines);

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::string rest_;  // the beginning of a line whose end has not come yet
};

}  // namespace vam::sim
