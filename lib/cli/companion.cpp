// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/companion.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include "base/error.hpp"
#include "base/system_error.hpp"

namespace vam::cli {

namespace {
std::filesystem::path own_folder() { return std::filesystem::canonical("/proc/self/exe").parent_path(); }
}  // namespace

std::string companion(const std::string& name) {
  for (const char* folder : {"lib/vam", VAM_LIBDIR "/vam"}) {
    const auto path = own_folder().parent_path() / folder / name;
    if (std::filesystem::exists(path)) return path;
  }
  throw Error{Fault::no_input, name + ": not found beside this program; reinstall the tools"};
}

void find_tools_beside() {
  const char* path = std::getenv("PATH");
  const std::string tools = own_folder().string() + (path == nullptr ? "" : ":" + std::string(path));
  setenv("PATH", tools.c_str(), 1);
}

void become_companion(const std::string& name, std::vector<std::string> arguments) {
  find_tools_beside();
  arguments.insert(arguments.begin(), companion(name));
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  execv(words.front(), words.data());
  throw system_error(Fault::no_input, arguments.front(), errno);
}

}  // namespace vam::cli
