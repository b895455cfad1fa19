// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/log_keeper.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/system_error.hpp"
#include "base/text/json.hpp"

namespace vam::device {

namespace {

constexpr std::chrono::seconds between{1};

// With its folder: a file that is new has its name on the disk only with that.
int open_regular(const std::string& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat about = {};
  if (fd < 0) return fd;
  if (fstat(fd, &about) != 0 || !S_ISREG(about.st_mode)) {
    close(fd);
    return -1;
  }
  const std::string folder = std::filesystem::path(path).parent_path().string();
  bring_to_disk({folder.empty() ? "." : folder});
  return fd;
}

}  // namespace

void bring_to_disk(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    const int opened = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (opened < 0) continue;
    (void)fsync(opened);
    close(opened);
  }
}

LogKeeper::LogKeeper(const std::vector<std::string>& paths, State state) : state_(std::move(state)) {
  for (const std::string& path : paths) {
    if (!path.empty() && path != "-") logs_.push_back({path});
  }
  if (!logs_.empty()) thread_ = std::thread([this] { run(); });
}

LogKeeper::~LogKeeper() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(access_);
    ended_ = true;
  }
  changed_.notify_all();
  thread_.join();
  for (const Log& log : logs_) {
    if (log.fd >= 0) close(log.fd);
  }
}

void LogKeeper::run() {
  std::unique_lock lock(access_);
  for (bool last = false; !last;) {
    last = ended_;
    lock.unlock();
    try {
      keep();
    } catch (const std::exception& error) {
      if (!std::exchange(warned_, true)) warn(std::string(error.what()) + "; a power failure may lose its last lines");
    }
    lock.lock();
    if (!last) changed_.wait_for(lock, between, [this] { return ended_; });
  }
}

// What is stated comes after the lines: they are on the disk.
void LogKeeper::keep() {
  Json stated = Json::object();
  std::string problem;
  for (Log& log : logs_) {
    if (log.fd < 0) log.fd = open_regular(log.path);
    if (log.fd < 0) continue;
    const std::int64_t before = log.end.bytes;
    if (!read_on(log.fd, log.end)) throw system_error(Fault::io, log.path + ": cannot be read", errno);
    log.grown |= log.end.bytes > before;
    if (!log.grown) continue;
    if (fdatasync(log.fd) != 0 && errno != EINVAL && errno != EROFS) {
      problem = log.path + ": cannot be brought to the disk (" + std::strerror(errno) + ")";
      continue;
    }
    log.grown = false;
    stated[std::filesystem::path(log.path).filename().string()] = {{"bytes", log.end.bytes}, {"chain", log.end.chain}};
  }
  if (state_ && !stated.empty()) state_(stated);
  if (!problem.empty()) throw Error{Fault::io, problem};
}

}  // namespace vam::device
