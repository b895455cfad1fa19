// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/renewal.hpp"

#include <chrono>
#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "base/json.hpp"

namespace vam::project {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds between_looks{100};

/// Of whole sinograms: a tool's output has its name only when it is complete. In the order of their names.
std::set<std::string> sinograms_in(const std::string& folder) {
  std::set<std::string> paths;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    if (entry->path().extension() == ".exr") paths.insert(entry->path().string());
  }
  if (failed) throw Error{Fault::no_input, folder + ": cannot read the folder (" + failed.message() + ")"};
  return paths;
}

}  // namespace

Renewal::Renewal(std::string folder, Live& live, Make make)
    : folder_(std::move(folder)), live_(live), make_(std::move(make)), seen_(sinograms_in(folder_)) {
  thread_ = std::thread([this] { watch(); });
}

Renewal::~Renewal() {
  ended_ = true;
  thread_.join();
}

void Renewal::watch() {
  for (; !ended_; std::this_thread::sleep_for(between_looks)) {
    try {
      look();
    } catch (const std::exception& error) {  // the print goes on with the frames it has
      live_.note("frames-refused", {{"message", error.what()}});
    }
  }
}

void Renewal::look() {
  for (const std::string& path : sinograms_in(folder_)) {
    if (ended_ || !seen_.insert(path).second) continue;
    make_(path);
  }
}

}  // namespace vam::project
