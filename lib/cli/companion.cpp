// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/companion.hpp"

#include <cstdlib>
#include <filesystem>

#include "base/error.hpp"

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

}  // namespace vam::cli
