// SPDX-License-Identifier: GPL-3.0-or-later
// Logs that a folder may hold, and that somebody may still be writing.
#pragma once

#include <fstream>
#include <optional>
#include <string>

#include "base/text/json_fwd.hpp"

namespace vam {

/// Whether a file of that name is there. Throws Fault::no_input where a link leads nowhere, or the name cannot be
/// reached; Fault::data for what is no regular file: a pipe would be waited for.
[[nodiscard]] bool has_regular_file(const std::string& path);

/// The lines of a log; one that is not there has none. Where its first line has a chain (base/log/chain.hpp), each line
/// must follow the one before it; where it has none, no line may.
class LogLines {
 public:
  /// tail_bytes: only the whole lines of so many bytes at its end; 0: all. Throws as has_regular_file() does, and
  /// Fault::no_input.
  explicit LogLines(const std::string& path, std::streamoff tail_bytes = 0);
  /// The next whole line, without its end; false when there is none yet. What is not whole is read again by the next
  /// call: its writer goes on, or is dead. Throws Fault::data for a line of more than 1 MiB, one that does not follow,
  /// and where the first states a version that is not read.
  bool next(std::string& line);
  /// The next that is an entry, which is kept when there is none yet; throws as parse_distinct() does, too.
  bool next(Json& entry);
  /// "log:7", of the last one.
  [[nodiscard]] std::string place() const;
  /// Every line so far follows from the first; also of none.
  [[nodiscard]] bool is_chained() const { return chained_.value_or(true); }

 private:
  void require_next(const std::string& line);

  std::string path_;
  std::ifstream stream_;
  bool tail_ = false, skipped_ = false;  // lines were, just before the next one
  long line_ = 0;                        // that was read, of the file; 0: not known
  std::optional<bool> chained_;
  std::string chain_;  // of the last line
};

}  // namespace vam
