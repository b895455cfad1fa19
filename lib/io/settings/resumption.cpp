// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <filesystem>

#include "base/error.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "io/settings/flip_log.hpp"
#include "io/settings/run_folder.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

namespace fs = std::filesystem;

constexpr const char* mark_name = "resumed.json";
constexpr std::uint64_t most_mark_bytes = std::uint64_t{1} << 20;

bool is_same(const fs::path& one, const fs::path& other) {
  std::error_code ignored;
  return fs::equivalent(one, other, ignored);
}

// A resumption without light has taken its mark back.
bool has_light(const std::string& run) {
  if (!has_regular_file((fs::path(run) / "flips.jsonl").string())) return false;
  FlipLog log(run);
  log.read();
  return log.lit() > 0;
}

// The mark as it stands; null: there is none.
Json mark_of(const std::string& run) {
  const std::string path = (fs::path(run) / mark_name).string();
  if (!has_regular_file(path)) return {};
  return parse_distinct(read_all(path, Content::text, most_mark_bytes), path);
}

}  // namespace

std::string resumed_by(const std::string& run) { return text_at(mark_of(run), "resumed_by"); }

void require_resumption(const std::string& run) {
  const std::string path = (fs::path(run) / mark_name).string();
  const Json mark = mark_of(run);
  if (!text_at(mark, "resumed_by").empty() && !text_at(mark, "utc").empty()) return;
  const std::string by = read_events(run).resumed_by;
  if (has_regular_file(path)) {
    throw Error{Fault::data, path + ": does not say when and by which print this one was resumed (utc, resumed_by)" +
                                 (by.empty() ? "; restore it, or remove it if the rest was not printed"
                                             : ", by events.jsonl " + by + "; restore it")};
  }
  if (by.empty()) return;
  throw Error{Fault::data, path + ": is gone, but events.jsonl states that " + by + " resumed this print; restore it"};
}

bool resumes(const std::string& run, const std::string& earlier) {
  const RunEvents links = read_events(run);
  if (links.resumes.empty() || is_same(run, earlier)) return false;
  const RunEvents first = read_events(earlier);
  return links.resumes_utc == first.armed_utc && links.sinogram_sha256 == first.sinogram_sha256;
}

std::vector<std::string> unmarked_resumptions(const std::vector<std::string>& runs) {
  std::vector<std::string> problems;
  std::error_code ignored;
  for (const std::string& earlier : runs) {
    const std::string mark = (fs::path(earlier) / mark_name).string();
    if (fs::exists(fs::symlink_status(mark, ignored)) || !read_events(earlier).resumed_by.empty()) continue;  // told
    for (const std::string& run : runs) {
      if (!resumes(run, earlier) || !has_light(run)) continue;
      problems.push_back(mark + ": is gone, but " + run +
                         "/events.jsonl states that it resumes this print; restore it");
      break;
    }
  }
  return problems;
}

}  // namespace vam::io
