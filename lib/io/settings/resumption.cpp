// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <filesystem>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "io/settings/flip_log.hpp"
#include "io/settings/run_folder.hpp"
#include "io/stream/log_lines.hpp"
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

// A name relative to where the print was, to the folder or to the one that holds it.
bool names_itself(const std::string& by, const std::string& run) {
  const fs::path folder(run);
  return is_same(by, folder) || is_same(folder / by, folder) || is_same(folder / ".." / by, folder);
}

// A resumption without light has taken its mark back.
bool has_light(const std::string& run) {
  if (!has_regular_file((fs::path(run) / "flips.jsonl").string())) return false;
  FlipLog log(run);
  log.read();
  return log.lit() > 0;
}

// What is wrong with the mark itself; empty: nothing.
std::string mark_problem(const std::string& run, const std::string& path) {
  std::error_code ignored;
  if (fs::is_symlink(fs::symlink_status(path, ignored))) return path + ": is a link, which no print leaves";
  try {
    const Json mark =
        parse_distinct(has_regular_file(path) ? read_all(path, Content::text, most_mark_bytes) : "", path);
    const std::string by = text_at(mark, "resumed_by");
    if (!by.empty() && names_itself(by, run)) return path + ": names its own folder as the print that resumed it";
    if (!by.empty() && !text_at(mark, "utc").empty()) return "";
  } catch (const Error& error) {
    if (error.fault != Fault::data) throw;
    return error.what();
  }
  return path + ": does not say when and by which print this one was resumed (utc, resumed_by)";
}

// Where the events state the resumption, too, removing the mark is no way out.
std::string remedy_of(const std::string& resumed_by) {
  return resumed_by.empty()
             ? "; restore it, or remove it if the rest was not printed"
             : "; restore it: {\"utc\": TIME, \"resumed_by\": FOLDER}, by events.jsonl that of " + resumed_by;
}

}  // namespace

std::string resumption_problem(const std::string& run) {
  const std::string path = (fs::path(run) / mark_name).string();
  std::error_code ignored;
  const bool is_there = fs::exists(fs::symlink_status(path, ignored));
  const std::string problem = is_there ? mark_problem(run, path) : "";
  if (is_there && problem.empty()) return "";
  try {
    const std::string by = read_events(run).resumed_by;
    if (is_there) return problem + remedy_of(by);
    return by.empty() ? "" : path + ": is gone, but events.jsonl states that " + by + " resumed this print; restore it";
  } catch (const Error& error) {
    if (error.fault != Fault::data) throw;
    return is_there ? problem + remedy_of("") : error.what();
  }
}

std::string resumed_by(const std::string& run) {
  const std::string path = (fs::path(run) / mark_name).string();
  if (!has_regular_file(path)) return "";
  return text_at(parse_distinct(read_all(path, Content::text, most_mark_bytes), path), "resumed_by");
}

void require_resumption(const std::string& run) {
  if (const std::string problem = resumption_problem(run); !problem.empty()) throw Error{Fault::data, problem};
}

std::string resumes_of(const std::string& run) { return read_events(run).resumes; }

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
