// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "base/system_error.hpp"
#include "device/os/process.hpp"

namespace vam::device {

namespace {

std::string lock_folder() {
  if (const char* wish = std::getenv("VAM_LOCK_DIR"); wish != nullptr && *wish != '\0') return wish;
  return access("/run/lock", W_OK) == 0 ? "/run/lock" : "/tmp";
}

std::string lock_path(const std::string& name) {
  std::string real = name;
  if (!name.empty() && name.front() == '/') {
    std::error_code none;
    const auto resolved = std::filesystem::canonical(name, none);
    if (!none) real = resolved;
  }
  for (char& c : real) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '-';
  }
  return lock_folder() + "/vam" + (real.front() == '-' ? "" : "-") + real + ".lock";
}

// Whether that process has the file open, otherwise than here. A number that is out of date may be another program's by
// now.
bool has_open(const std::string& pid, int fd) {
  struct stat mine {};
  fstat(fd, &mine);
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/" + pid + "/fd", none)) {
    struct stat its {};
    if (entry.path() == "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(fd)) continue;
    if (stat(entry.path().c_str(), &its) == 0 && its.st_ino == mine.st_ino && its.st_dev == mine.st_dev) return true;
  }
  return false;
}

// The guardian that has it still, when who took it has ended; 0: none that is seen.
int guardian_of(int fd) {
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", none)) {
    std::string name;
    std::ifstream file(entry.path() / "comm");
    const std::string pid = entry.path().filename();
    if (std::getline(file, name) && name == guardian_name && has_open(pid, fd)) return std::atoi(pid.c_str());
  }
  return 0;
}

// Who has the lock; 0: nobody who is seen to, nullopt: this process, from now on. A holder writes its number just after
// it has the lock, and who only asks whether it is free (locked_names) has it for a moment: so not at once.
std::optional<int> lock(int fd, std::string& pid) {
  for (int attempt = 0; flock(fd, LOCK_EX | LOCK_NB) != 0; ++attempt) {
    std::array<char, 32> text{};
    if (pread(fd, text.data(), text.size() - 1, 0) > 0) pid.assign(text.data(), strcspn(text.data(), "\n"));
    if (has_open(pid, fd)) return std::atoi(pid.c_str());
    if (attempt == 20) return guardian_of(fd);
    usleep(5000);
  }
  return std::nullopt;
}

}  // namespace

DeviceLock::DeviceLock(const std::string& name) {
  const std::string path = lock_path(name);
  // Without O_CREAT first: in a sticky folder the kernel refuses to "create" what another user owns.
  fd_ = open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (fd_ < 0 && errno == ENOENT) {
    fd_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (fd_ >= 0) fchmod(fd_, 0666);  // past the umask: the next user may be another one
  }
  if (fd_ < 0) {
    throw system_error(Fault::no_output, path + ": cannot lock the device", errno,
                       "set VAM_LOCK_DIR to a folder writable by all users");
  }
  std::string pid = "unknown";
  if (const auto holder = lock(fd_, pid)) {
    close(fd_);
    throw InUse{name + ": in use by process " + pid + "; try again when it has ended", *holder};
  }
  pid = std::to_string(getpid()) + "\n";
  if (ftruncate(fd_, 0) != 0 || pwrite(fd_, pid.data(), pid.size(), 0) != static_cast<ssize_t>(pid.size())) {
    const int reason = errno;
    close(fd_);
    throw Error{Fault::io, path + ": cannot write the lock (" + std::strerror(reason) + ")"};
  }
}

DeviceLock::~DeviceLock() { close(fd_); }

std::vector<std::string> locked_names(const std::string& beginning) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(lock_folder(), none)) {
    const std::string file = entry.path().filename().string();
    if (!file.starts_with("vam-" + beginning) || !file.ends_with(".lock")) continue;
    const std::string name = file.substr(4, file.size() - 9);
    const int fd = open(entry.path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (fd >= 0 && flock(fd, LOCK_SH | LOCK_NB) != 0) names.push_back(name);
    close(fd);
  }
  return names;
}

}  // namespace vam::device
