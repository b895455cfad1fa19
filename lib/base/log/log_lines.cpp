// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/log/log_lines.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <utility>

#include "base/error.hpp"
#include "base/log/chain.hpp"
#include "base/system_error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"

namespace vam {

bool has_regular_file(const std::string& path) {
  struct stat about = {};
  if (stat(path.c_str(), &about) != 0) {
    const int problem = errno;
    if (problem != ENOENT && problem != ENOTDIR) throw system_error(Fault::no_input, path + ": cannot open", problem);
    if (lstat(path.c_str(), &about) != 0) return false;
    throw Error{Fault::no_input, path + ": links to a file that is gone; restore it, or remove the link"};
  }
  if (!S_ISREG(about.st_mode)) throw Error{Fault::data, path + ": is not a regular file; restore it"};
  return true;
}

LogLines::LogLines(const std::string& path, std::streamoff tail_bytes) : path_(path) {
  if (!has_regular_file(path)) return;
  stream_.open(path);
  if (!stream_.is_open()) throw system_error(Fault::no_input, path + ": cannot open", errno);
  if (std::string first; tail_bytes == 0 || !next(first)) return;
  stream_.seekg(0, std::ios::end);
  const std::streamoff size = stream_.tellg();
  if (size <= tail_bytes) {
    *this = LogLines(path);
    return;
  }
  stream_.seekg(size - tail_bytes);
  stream_.ignore(tail_bytes, '\n');  // begins somewhere within
  line_ = 0;
  tail_ = skipped_ = true;
}

std::string LogLines::place() const { return path_ + (line_ > 0 ? ":" + std::to_string(line_) : ""); }

void LogLines::require_next(const std::string& line) {
  line_ += tail_ ? 0 : 1;
  const std::string chain = chain_of(line);
  if (!chained_) {
    (void)parse_distinct(line, path_);
    chained_ = !chain.empty();
  }
  const bool known = !std::exchange(skipped_, false);
  if (*chained_ == chain.empty() || (*chained_ && known && !follows(line, chain_)))
    throw Error{Fault::data, place() + ": does not follow from the line before it; the log was changed; restore it"};
  chain_ = chain;
}

bool LogLines::next(std::string& line) {
  constexpr std::size_t most_bytes = std::size_t{1} << 20;
  if (!stream_.is_open()) return false;
  const auto begin = stream_.tellg();
  line.clear();
  std::streambuf& bytes = *stream_.rdbuf();
  constexpr int end_of_file = std::char_traits<char>::eof();
  for (int byte = bytes.sbumpc(); byte != end_of_file; byte = bytes.sbumpc()) {
    if (byte == '\n') {
      require_next(line);
      return true;
    }
    if (line.size() == most_bytes) {
      throw Error{Fault::data,
                  path_ + ": has a line of more than 1 MiB, from byte " + std::to_string(begin) + " on; it is damaged"};
    }
    line.push_back(static_cast<char>(byte));
  }
  stream_.clear();
  stream_.seekg(begin);
  return false;
}

bool LogLines::next(Json& entry) {
  for (std::string line; next(line);) {
    Json whole = parse_distinct(line, path_);
    if (!whole.is_object()) continue;
    entry = std::move(whole);
    return true;
  }
  return false;
}

}  // namespace vam
