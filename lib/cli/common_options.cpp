// SPDX-License-Identifier: GPL-3.0-or-later
// The options that every tool has.
#include <algorithm>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "cli/private/command_line.hpp"
#include "cli/private/values.hpp"

namespace vam::cli {

namespace {

constexpr const char *progress_flag = "--progress", *quiet_flag = "--quiet", *verbose_flag = "--verbose";
const std::vector<std::string> styles{"line", "json", "none"};  // as ProgressStyle

/// Its value, empty of a flag; nothing where it is not given.
std::optional<std::string> take(const Option& option, std::vector<std::string>& words) {
  const auto names = split(option.flag, ',');
  const auto is_it = [&](const std::string& word) {
    return std::find(names.begin(), names.end(), flag_of(word)) != names.end();
  };
  const auto end = std::find(words.begin(), words.end(), "--");
  const auto word = std::find_if(words.begin(), end, is_it);
  if (word == end) return {};
  const std::string name = long_flag(option);
  if (std::find_if(word + 1, end, is_it) != end) throw Error{Fault::usage, name + ": given twice"};
  const bool joined = word->find('=') != std::string::npos;
  if (option.value_name.empty()) {
    if (joined) throw Error{Fault::usage, name + ": takes no value"};
    words.erase(word);
    return "";
  }
  if (!joined && word + 1 == end) throw Error{Fault::usage, name + ": needs a value"};
  std::string value = joined ? word->substr(word->find('=') + 1) : *(word + 1);
  words.erase(word, word + (joined ? 1 : 2));
  return value;
}

}  // namespace

const std::vector<Option>& common_options() {
  static const std::vector<Option> all{
      {memory_flag,
       "GIB",
       "Maximum amount of memory; a computation that needs more is refused, or uses scratch files where this page says "
       "so.",
       "the memory that is available",
       "more than 0, at most 1e6",
       {}},
      {progress_flag, "WORD",
       "Progress of work that takes longer than half a second, on standard error. line: one line, on a terminal only, "
       "with the share done and an estimate of the time left; the tools of a pipeline share this line. json: one "
       "object a line (vam-formats(7), Progress).",
       styles.front(), "", styles},
      {std::string("-q,") + quiet_flag, "", "Print errors only: no progress, summaries or warnings.", "", "", {}},
      {std::string("-v,") + verbose_flag,
       "",
       "Print summaries also where standard error is not a terminal, the duration of each step, and at the end time "
       "and memory used.",
       "",
       "",
       {}},
  };
  return all;
}

CommonOptions take_common_options(std::vector<std::string>& words) {
  CommonOptions values;
  for (const Option& option : common_options()) {
    const auto value = take(option, words);
    if (!value) continue;
    const std::string name = long_flag(option);
    if (name == memory_flag) values.memory_gib = value;
    if (name == quiet_flag) values.log.quiet = true;
    if (name == verbose_flag) values.log.verbose = true;
    if (name != progress_flag) continue;
    const auto style = std::find(styles.begin(), styles.end(), *value);
    if (style == styles.end()) throw not_one_of(name, *value, styles);
    values.log.progress = static_cast<ProgressStyle>(style - styles.begin());
  }
  if (values.log.quiet && values.log.verbose) {
    throw Error{Fault::usage, std::string(quiet_flag) + ": contradicts " + verbose_flag};
  }
  return values;
}

}  // namespace vam::cli
