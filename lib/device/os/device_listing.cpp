// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/device_listing.hpp"

#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "device/os/lock.hpp"

namespace vam::device {

std::string lock_obstacle(const std::string& name) {
  try {
    const DeviceLock lock(name);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

std::string node_obstacle(const std::string& path) {
  if (access(path.c_str(), R_OK | W_OK) == 0) return lock_obstacle(path);
  if (errno != EACCES) return path + ": " + std::strerror(errno);
  struct stat about {};
  const bool seen = stat(path.c_str(), &about) == 0;
  const group* owner = seen && (about.st_mode & 0060) == 0060 ? getgrgid(about.st_gid) : nullptr;
  if (owner == nullptr || about.st_gid == 0) return "not permitted to this user; add a udev rule with TAG+=\"uaccess\"";
  const std::string name = owner->gr_name;
  return "not permitted to this user; run `sudo usermod -aG " + name + " $USER` and log in again";
}

}  // namespace vam::device
