// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/renewal.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/text/json.hpp"

namespace vam::project {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds between_looks{100};

struct Sinogram {
  std::string path, mark;  // which changes when another file takes the name
  fs::file_time_type written;
  bool is_file;
};

/// Of whole sinograms: a tool's output has its name only when it is complete; hidden ones are on their way to it. In
/// the order in which they were written.
std::vector<Sinogram> sinograms_in(const std::string& folder) {
  std::vector<Sinogram> all;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    if (entry->path().extension() != ".exr" || entry->path().filename().string().front() == '.') continue;
    struct stat status {};
    const std::string path = entry->path().string();
    if (stat(path.c_str(), &status) != 0) continue;  // just taken away
    const auto written = entry->last_write_time(failed);
    const std::string mark = std::to_string(status.st_ino) + ':' + std::to_string(written.time_since_epoch().count());
    all.push_back({path, path + ':' + mark, written, S_ISREG(status.st_mode)});
  }
  if (failed) throw Error{Fault::no_input, folder + ": cannot read the folder (" + failed.message() + ")"};
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.written < b.written; });
  return all;
}

}  // namespace

Renewal::Renewal(std::string folder, Live& live, Make make)
    : folder_(std::move(folder)), live_(live), make_(std::move(make)) {
  for (const Sinogram& one : sinograms_in(folder_)) seen_.insert(one.mark);
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
    } catch (const std::exception& error) {
      refuse(error.what());
    } catch (...) {
      refuse("interrupted");
    }
  }
}

/// A folder that cannot be read is told once.
void Renewal::refuse(const std::string& message) {
  if (ended_ || message == refused_) return;
  refused_ = message;
  try {
    live_.note("frames-refused", {{"message", message}});
  } catch (...) {
    // A log that cannot be written ends the print by its next flip, in good order.
  }
}

void Renewal::look() {
  std::string newest;
  for (const Sinogram& one : sinograms_in(folder_)) {
    if (!seen_.insert(one.mark).second) continue;
    if (one.is_file) {
      newest = one.path;
    } else {
      refuse(one.path + ": is no regular file");  // opening it could take for ever
    }
  }
  if (newest.empty()) return;
  refused_.clear();
  make_(newest, ended_);
}

}  // namespace vam::project
