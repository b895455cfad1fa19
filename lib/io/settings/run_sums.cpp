// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/run_sums.hpp"

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/system_error.hpp"
#include "base/text.hpp"
#include "io/stream/log_lines.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

namespace fs = std::filesystem;

constexpr const char* list_name = "SHA256SUMS";
constexpr std::size_t digits = 64;

std::string path_in(const std::string& folder, const std::string& name) { return (fs::path(folder) / name).string(); }

// "HASH  ./NAME", "HASH *NAME": the name; empty where it is none of a file in the folder.
std::string name_of(const std::string& line) {
  if (line.size() < digits + 3 || line.find_first_not_of("0123456789abcdef") != digits || line[digits] != ' ')
    return "";
  std::string name = line.substr(digits + 2);
  if (name.starts_with("./")) name = name.substr(2);
  const fs::path path(name);
  const bool leaves = path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end();
  return leaves ? "" : name;
}

// The regular files of a folder and those in it, links left out.
std::vector<std::string> files_of(const std::string& folder) {
  std::error_code problem;
  std::vector<std::string> names;
  for (fs::recursive_directory_iterator entry(folder, problem), end; !problem && entry != end;
       entry.increment(problem)) {
    if (fs::is_regular_file(entry->symlink_status())) names.push_back(fs::relative(entry->path(), folder).string());
  }
  if (problem) throw system_error(Fault::no_input, folder + ": cannot read the folder", problem.value());
  std::sort(names.begin(), names.end());
  return names;
}

std::string gone(const std::string& folder, const std::string& name) {
  try {
    if (has_regular_file(path_in(folder, name))) return "";
  } catch (const Error& error) {  // what stands in its place
    return error.what();
  }
  return path_in(folder, name) + ": is gone, but " + list_name + " lists it; restore it";
}

}  // namespace

bool has_run_sums(const std::string& folder) { return has_regular_file(path_in(folder, list_name)); }

RunSums read_run_sums(const std::string& folder) {
  const std::string path = path_in(folder, list_name);
  std::vector<std::string> lines = split(read_all(path, Content::text, std::uint64_t{256} << 20), '\n');
  if (!lines.empty() && lines.back().empty()) lines.pop_back();
  RunSums sums;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string name = name_of(lines[i]);
    if (!name.empty() && sums.try_emplace(name, lines[i].substr(0, digits)).second) continue;
    throw Error{Fault::data, path + ": line " + std::to_string(i + 1) +
                                 (name.empty() ? ": is not a hash and the name of a file in the folder"
                                               : ": names a file for the second time") +
                                 "; it was cut or changed; restore it"};
  }
  if (sums.empty()) throw Error{Fault::data, path + ": is empty; it was cut; restore it"};
  return sums;
}

void require_run_logs(const std::string& folder) {
  if (!has_run_sums(folder)) return;
  const RunSums sums = read_run_sums(folder);
  for (const char* name : {"events.jsonl", "flips.jsonl", "printer.toml"}) {
    const bool needed = std::string(name) == "events.jsonl" || has_regular_file(path_in(folder, name));
    if (!needed || sums.contains(name)) continue;
    throw Error{Fault::data, path_in(folder, list_name) + ": has no hash of " + name +
                                 "; it was cut or changed; restore it, or delete it to use the logs unverified"};
  }
  for (const auto& file : sums) {  // images need not be read
    const fs::path name(file.first);
    const fs::path ending = name.extension();
    const bool is_log = ending == ".jsonl" || ending == ".json" || ending == ".toml";
    if (!is_log || (name.has_parent_path() && name.filename() != "manifest.jsonl")) continue;
    if (const std::string problem = sum_problem(folder, file); !problem.empty()) throw Error{Fault::data, problem};
  }
}

std::string sum_problem(const std::string& folder, const RunSums::value_type& file) {
  const auto& [name, hash] = file;
  if (std::string problem = gone(folder, name); !problem.empty()) return problem;
  if (sha256_of(path_in(folder, name)) == hash) return "";
  return path_in(folder, name) + ": changed after the print (its hash is not that in " + list_name +
         "); restore the original file";
}

std::vector<std::string> run_damage(const std::string& folder, const RunSums& sums, bool fast) {
  std::vector<std::string> damage;
  for (const auto& file : sums) {
    const std::string problem = fast ? gone(folder, file.first) : sum_problem(folder, file);
    if (!problem.empty()) damage.push_back(problem);
  }
  for (const std::string& name : files_of(folder)) {
    if (name == list_name || name == "resumed.json" || sums.contains(name)) continue;
    damage.push_back(path_in(folder, name) + ": is not in " + list_name +
                     ": it was added after the print, or the list was cut; remove the file, or restore the list");
  }
  return damage;
}

}  // namespace vam::io
