// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/log_lines.hpp"
#include "base/system_error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "io/settings/flip_log.hpp"
#include "io/settings/run_folder.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

namespace fs = std::filesystem;

constexpr const char* list_name = "SHA256SUMS";
constexpr const char* resumed_name = "resumed.json";
constexpr const char* sinogram_name = "sinogram.exr";
constexpr std::size_t digits = 64;

std::string path_in(const std::string& folder, const std::string& name) { return (fs::path(folder) / name).string(); }

// "HASH  ./NAME", "HASH *NAME": the name; empty where it is none of a file in the folder.
std::string summed_file(const std::string& line) {
  if (line.size() < digits + 3 || line.find_first_not_of("0123456789abcdef") != digits || line[digits] != ' ')
    return "";
  std::string name = line.substr(digits + 2);
  if (name.starts_with("./")) name = name.substr(2);
  const fs::path path(name);
  const bool leaves = path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end();
  return leaves ? "" : name;
}

// What a folder and those in it hold, links and the like too, but for the folders themselves.
std::vector<std::string> entries_of(const std::string& folder) {
  std::error_code problem;
  std::vector<std::string> names;
  for (fs::recursive_directory_iterator entry(folder, problem), end; !problem && entry != end;
       entry.increment(problem)) {
    if (!fs::is_directory(entry->symlink_status())) names.push_back(entry->path().lexically_relative(folder).string());
  }
  if (problem) throw system_error(Fault::no_input, folder + ": cannot read the folder", problem.value());
  std::sort(names.begin(), names.end());
  return names;
}

bool is_link(const std::string& path) {
  std::error_code ignored;
  return fs::is_symlink(fs::symlink_status(path, ignored));
}

// What a check says is wrong with a file; a lack of the system, as of open files, says nothing of it.
template <class Check>
std::string problem_of(const Check& check) {
  try {
    check();
    return "";
  } catch (const Error& error) {
    if (error.fault != Fault::data && error.fault != Fault::no_input) throw;
    return error.what();
  }
}

// A file of the list is there, and unless `fast` what it was.
void require_listed(const std::string& folder, const RunSums::value_type& file, bool fast) {
  const std::string path = path_in(folder, file.first);
  if (!has_regular_file(path)) throw Error{Fault::data, path + ": is gone, but " + list_name + " lists it; restore it"};
  if (fast || sha256_of(path) == file.second) return;
  throw Error{Fault::data, path + ": changed after the print (its hash is not that in " + list_name +
                               "); restore the original file"};
}

[[noreturn]] void refuse_unlisted(const std::string& folder, const std::string& name) {
  throw Error{Fault::data, path_in(folder, name) + ": is not in " + list_name +
                               ": it was added after the print, or the list was cut; remove the file, or restore "
                               "the list"};
}

// vam-print leaves a link to the sinogram, in whose place copies of the folder have the file; the events have its hash.
void require_sinogram(const std::string& folder, bool by_name) {
  const std::string path = path_in(folder, sinogram_name);
  try {
    if (!has_regular_file(path) || by_name) return;
  } catch (const Error& error) {
    if (error.fault != Fault::no_input) throw;
    std::error_code ignored;
    return warn(path + ": links to " + fs::read_symlink(path, ignored).string() +
                ", which cannot be read, so that the sinogram was not verified; restore it, or remove the link");
  }
  if (!is_link(path) && !states_sinogram(folder)) refuse_unlisted(folder, sinogram_name);
  require_sinogram_of(folder, path);
}

// vam-print seals the settings before it is armed; a printer file of a user's own is in no run.
void require_sealed_settings(const std::string& folder) {
  const std::string path = path_in(folder, "printer.toml");
  if (!has_regular_file(path_in(folder, "events.jsonl")) || !has_regular_file(path)) return;
  if (require_text_seal(read_all(path, Content::text, std::uint64_t{1} << 20), path)) return;
  throw Error{Fault::data, path + ": has no seal, with which a print writes it; it was cut or changed; restore it"};
}

}  // namespace

bool has_run_sums(const std::string& folder) { return has_regular_file(path_in(folder, list_name)); }

RunSums read_run_sums(const std::string& folder) {
  const std::string path = path_in(folder, list_name);
  std::vector<std::string> lines = split(read_all(path, Content::text, std::uint64_t{256} << 20), '\n');
  if (!lines.empty() && lines.back().empty()) lines.pop_back();
  RunSums sums;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string name = summed_file(lines[i]);
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
  if (!has_run_sums(folder)) {
    require_run_versions(folder);
    require_sealed_settings(folder);
    return require_logs(folder);
  }
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
    if (const std::string problem = problem_of([&] { require_listed(folder, file, false); }); !problem.empty())
      throw Error{Fault::data, problem};
  }
}

void require_run_settings(const std::string& folder) {
  const std::string path = path_in(folder, "printer.toml");
  if (has_regular_file(path) || !has_regular_file(path_in(folder, "events.jsonl"))) return;
  throw Error{Fault::data, path +
                               ": is gone, without which the print can be neither resumed nor its dose computed; "
                               "restore it"};
}

void require_run(const std::string& folder) {
  if (std::error_code ignored; !fs::is_directory(folder, ignored))
    throw Error{Fault::no_input, folder + ": not a folder; give the run folder of vam-print"};
  require_run_logs(folder);
  require_resumption(folder);
  if (!read_events(folder).outcome) require_run_settings(folder);
}

void require_run_versions(const std::string& folder) {
  for (const std::string& name : entries_of(folder)) {
    const std::string path = path_in(folder, name);
    if (!fs::is_regular_file(fs::symlink_status(path))) continue;
    std::string first;
    if (name.ends_with(".jsonl")) LogLines(path).next(first);
    if (name.ends_with(".json")) (void)parse_distinct(read_all(path, Content::text, std::uint64_t{64} << 20), path);
  }
}

std::vector<std::string> run_damage(const std::string& folder, const RunSums& sums, bool fast) {
  std::vector<std::string> damage;
  const auto attempt = [&](const auto& check) {
    if (const std::string problem = problem_of(check); !problem.empty()) damage.push_back(problem);
  };
  for (const auto& file : sums) attempt([&] { require_listed(folder, file, fast); });
  const bool has_logs = damage.empty();
  if (!sums.contains(resumed_name)) attempt([&] { require_resumption(folder); });
  for (const std::string& name : entries_of(folder)) {
    if (name == list_name || name == resumed_name || sums.contains(name)) continue;
    attempt([&] {
      if (name != sinogram_name) refuse_unlisted(folder, name);
      require_sinogram(folder, fast || !has_logs);
    });
  }
  return damage;
}

}  // namespace vam::io
