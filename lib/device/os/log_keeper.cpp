// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/log_keeper.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "base/log/chain.hpp"
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
  const int above = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (above < 0) return fd;
  (void)fsync(above);
  close(above);
  return fd;
}

}  // namespace

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
    log.grown |= read_on(log);
    if (!log.grown) continue;
    if (fdatasync(log.fd) != 0 && errno != EINVAL && errno != EROFS) {
      problem = log.path + ": cannot be brought to the disk (" + std::strerror(errno) + ")";
      continue;
    }
    log.grown = false;
    stated[std::filesystem::path(log.path).filename().string()] = {{"bytes", log.bytes}, {"chain", log.chain}};
  }
  if (state_ && !stated.empty()) state_(stated);
  if (!problem.empty()) throw Error{Fault::io, problem};
}

// Whether there are more whole lines.
bool LogKeeper::read_on(Log& log) {
  std::string more;
  std::array<char, 65536> room{};
  for (ssize_t count = 1; count > 0; more.append(room.data(), static_cast<std::size_t>(count))) {
    count = pread(log.fd, room.data(), room.size(), log.bytes + std::ssize(more));
    if (count < 0) throw system_error(Fault::io, log.path + ": cannot be read", errno);
  }
  const std::size_t end = more.rfind('\n');
  if (end == std::string::npos) return false;
  log.bytes += static_cast<std::int64_t>(end) + 1;
  more.resize(end);
  log.chain = chain_of(more.substr(more.rfind('\n') + 1));  // npos + 1: all
  return true;
}

}  // namespace vam::device
