// SPDX-License-Identifier: GPL-3.0-or-later
// The files that a tool reads and writes: no input is lost to an output, no stream is used twice.
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>

#include "base/error.hpp"
#include "base/printer_path.hpp"
#include "base/sha256.hpp"
#include "base/text/text.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "cli/private/app_state.hpp"

namespace vam::cli {

namespace {

namespace fs = std::filesystem;

// A device or a pipe is no file that a second writer would replace.
bool is_one_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  if (fs::exists(a, ignored) && !fs::is_regular_file(a, ignored)) return false;
  return fs::weakly_canonical(fs::absolute(a), ignored) == fs::weakly_canonical(fs::absolute(b), ignored);
}

// Endings that say a format.
bool says_format(const std::string& path) {
  static const std::set<std::string> known{".3mf", ".amf",  ".avi",  ".bmp",  ".csv",  ".exr", ".gif", ".glb",  ".gz",
                                           ".h5",  ".html", ".jpeg", ".jpg",  ".json", ".mkv", ".mov", ".mp4",  ".mrc",
                                           ".npy", ".npz",  ".nrrd", ".obj",  ".off",  ".pdf", ".ply", ".png",  ".step",
                                           ".stl", ".svg",  ".tif",  ".tiff", ".toml", ".txt", ".vdb", ".xlsx", ".zip"};
  std::string ending = fs::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return known.count(ending) != 0;
}

// A name that says another format than the file's would mislead whoever opens it.
void require_ending(const Option& option) {
  const std::string path = option.value();
  if (option.endings.empty() || path == "-" || path.starts_with("/dev/")) return;
  if (option.any_name && !says_format(path)) return;
  const auto ends = [&](const std::string& ending) { return path.ends_with(ending); };
  if (std::any_of(option.endings.begin(), option.endings.end(), ends)) return;
  throw Error{Fault::usage, long_flag(option) + ": '" + path + "' must end in " + join(option.endings, " or ")};
}

// "-" is the given standard descriptor.
bool is_same_file(const std::string& input, const std::string& output) {
  struct stat in = {};
  struct stat out = {};
  const auto identify = [](const std::string& path, int standard, struct stat& about) {
    return (path == "-" ? fstat(standard, &about) : stat(path.c_str(), &about)) == 0;
  };
  if (!identify(input, STDIN_FILENO, in) || !identify(output, STDOUT_FILENO, out)) return false;
  return S_ISREG(in.st_mode) && in.st_dev == out.st_dev && in.st_ino == out.st_ino;
}

// Each name of it is read from where the one before ended, or takes what another waits for.
bool is_standard_input(const std::string& path) {
  return path == "-" || path == "/dev/stdin" || path == "/dev/fd/0" || path == "/proc/self/fd/0";
}

// The contents of a file that may change between two runs of a job.
std::string hash_of(const std::string& path) {
  if (!fs::is_regular_file(path)) return "";
  std::ifstream file(path, std::ios::binary);
  Sha256 hash;
  std::vector<char> block(1 << 20);
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0) {
    hash.add(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  return hash.digest();
}

}  // namespace

std::vector<std::string> App::inputs() const {
  std::vector<std::string> paths;
  for (const auto& positional : state_->tool.positionals) {
    const auto& unless = positional.unless;
    if (!positional.reads || std::any_of(unless.begin(), unless.end(), [&](const auto& flag) { return given(flag); })) {
      continue;
    }
    for (const auto& path : positional.values()) paths.push_back(path);
  }
  for (const auto& group : state_->tool.groups) {
    for (const auto& option : group.options) {
      if (option.reads) paths.push_back(option.value());
      if (option.flag == printer_flag && option.value() != "-" && !given("--print-printer"))
        paths.push_back(printer_path(option.value()));
    }
  }
  std::erase(paths, "");
  return paths;
}

void App::require_own_inputs() const {
  const auto paths = inputs();
  const auto streams = std::count_if(paths.begin(), paths.end(), is_standard_input);
  if (streams > 1) {
    throw Error{Fault::usage, std::to_string(streams) +
                                  " inputs are standard input, which can be read once; name files for the others"};
  }
  for (const auto& group : state_->tool.groups) {
    for (const auto& option : group.options) {
      const std::string output = option.writes ? option.value() : "";
      if (output.empty()) continue;
      if (std::none_of(paths.begin(), paths.end(), [&](const auto& path) { return is_same_file(path, output); }))
        continue;
      throw Error{Fault::usage, (output == "-" ? "stdout" : output) + ": is also the input; write to another file"};
    }
  }
}

void App::require_own_outputs() const {
  std::vector<const Option*> before;
  for (const auto& group : state_->tool.groups) {
    for (const auto& option : group.options) {
      if (!option.writes || option.value().empty()) continue;
      require_ending(option);
      for (const Option* other : before) {
        if (option.value() == "-" && other->value() == "-") {
          throw Error{Fault::usage, long_flag(option) + ": would write to standard output, as " + long_flag(*other) +
                                        " does; name a file for one of them"};
        }
        if (!is_one_file(option.value(), other->value())) continue;
        throw Error{Fault::usage, long_flag(option) + ": would write to " + option.value() + ", as " +
                                      long_flag(*other) + " does; name another file"};
      }
      before.push_back(&option);
    }
  }
}

std::string App::job() const {
  std::string text;
  for (const auto& group : state_->tool.groups) {
    for (const auto& option : group.options) {
      if (!option.in_job) continue;
      text += long_flag(option) + "=" + option.value() + "\n";
      if (option.reads) text += hash_of(option.value()) + "\n";
    }
  }
  return text;
}

}  // namespace vam::cli
