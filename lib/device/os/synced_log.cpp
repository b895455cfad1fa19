// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/synced_log.hpp"

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
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "device/os/event_log.hpp"

namespace vam::device {

namespace {

constexpr std::chrono::seconds between{1};

int open_regular(const std::string& path) {
  if (path.empty() || path == "-") return -1;
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat about = {};
  if (fd < 0 || (fstat(fd, &about) == 0 && S_ISREG(about.st_mode))) return fd;
  close(fd);
  return -1;
}

// A file that is new has its name on the disk only with its folder.
void sync_folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int fd = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  (void)fsync(fd);
  close(fd);
}

}  // namespace

SyncedLog::SyncedLog(std::string log, const std::string& seals) : path_(std::move(log)), fd_(open_regular(path_)) {
  if (fd_ < 0) return;
  if (!seals.empty()) seals_ = std::make_unique<EventLog>(seals);
  thread_ = std::thread([this] { run(); });
}

SyncedLog::~SyncedLog() {
  if (fd_ < 0) return;
  {
    const std::lock_guard lock(access_);
    ended_ = true;
  }
  changed_.notify_all();
  thread_.join();
  close(fd_);
}

void SyncedLog::run() {
  attempt([this] { seal(); });  // of nothing yet: a busy disk delays the next one, so that none would look like a cut
  sync_folder_of(path_);
  std::unique_lock lock(access_);
  for (bool last = false; !last;) {
    last = ended_;
    lock.unlock();
    attempt([this] { keep(); });
    lock.lock();
    if (!last) changed_.wait_for(lock, between, [this] { return ended_; });
  }
}

// Takes in the whole lines that were added.
bool SyncedLog::read_on() {
  const std::uint64_t before = bytes_;
  std::array<char, 65536> room{};
  for (;;) {
    const auto at = static_cast<off_t>(bytes_ + begun_.size());
    const ssize_t count = pread(fd_, room.data(), room.size(), at);
    if (count < 0) throw Error{Fault::io, path_ + ": read failed (" + std::strerror(errno) + ")"};
    if (count == 0) return bytes_ > before;
    begun_.append(room.data(), static_cast<std::size_t>(count));
    const std::size_t whole = begun_.rfind('\n') + 1;  // 0: none
    hash_.add(begun_.data(), whole);
    bytes_ += whole;
    begun_.erase(0, whole);
  }
}

// The seal comes after the lines: what it states is on the disk.
void SyncedLog::keep() {
  if (!read_on()) return;
  if (fdatasync(fd_) != 0 && errno != EINVAL && errno != EROFS)
    throw Error{Fault::io, path_ + ": cannot be brought to the disk (" + std::strerror(errno) + ")"};
  seal();
  if (seals_) seals_->sync();
}

void SyncedLog::seal() {
  if (!seals_) return;
  (*seals_)("sealed", {{"log", std::filesystem::path(path_).filename().string()},
                       {"bytes", bytes_},
                       {"sha256", Sha256(hash_).digest()}});
}

template <class Step>
void SyncedLog::attempt(const Step& step) {
  try {
    step();
  } catch (const std::exception& error) {
    warn_once(error.what());
  }
}

void SyncedLog::warn_once(const std::string& problem) {
  if (!std::exchange(warned_, true)) warn(problem + "; a power failure may lose its last lines");
}

}  // namespace vam::device
