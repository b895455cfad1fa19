// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/lock.hpp"

#include <grp.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "device/os/device_listing.hpp"
#include "testing.hpp"

using namespace vam;
using device::DeviceLock;

namespace {

struct LockFolder {
  LockFolder() {
    char name[] = "/tmp/vam-lock-test.XXXXXX";
    path = mkdtemp(name);
    setenv("VAM_LOCK_DIR", path.c_str(), 1);
  }
  ~LockFolder() {
    unsetenv("VAM_LOCK_DIR");
    std::filesystem::remove_all(path);
  }
  std::string path;
};

// A process that takes the lock, reports it and waits.
pid_t holder(const std::string& name) {
  std::array<int, 2> ready{};
  REQUIRE(pipe(ready.data()) == 0);
  const pid_t child = fork();
  if (child == 0) {
    const DeviceLock lock(name);
    (void)!write(ready[1], "x", 1);
    pause();
    _exit(0);
  }
  char byte = 0;
  REQUIRE(read(ready[0], &byte, 1) == 1);
  close(ready[0]);
  close(ready[1]);
  return child;
}

// As a user without rights sees it.
std::string obstacle_for_nobody(const std::string& node) {
  std::array<int, 2> line{};
  REQUIRE(pipe(line.data()) == 0);
  const pid_t child = fork();
  if (child == 0) {
    constexpr unsigned nobody = 65534;
    const bool left = setgroups(0, nullptr) == 0 && setgid(nobody) == 0 && setuid(nobody) == 0;
    const std::string text = left ? device::node_obstacle(node) : "still root";
    (void)!write(line[1], text.data(), text.size());
    _exit(0);
  }
  close(line[1]);
  std::array<char, 200> text{};
  const ssize_t size = read(line[0], text.data(), text.size());
  close(line[0]);
  waitpid(child, nullptr, 0);
  return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
}

}  // namespace

TEST_CASE("The second user learns who the first one is; kill -9 frees the device") {
  const LockFolder folder;
  const pid_t first = holder("/dev/null");
  CHECK(fault_of([] { DeviceLock("/dev/null"); }) == Fault::busy);
  const std::string message = message_of([] { DeviceLock("/dev/null"); });
  CHECK(has(message, "process " + std::to_string(first)));
  kill(first, SIGKILL);
  waitpid(first, nullptr, 0);
  CHECK_FALSE(fault_of([] { DeviceLock("/dev/null"); }).has_value());
}

TEST_CASE("Who lists what is locked neither marks what is free nor takes it from one who begins") {
  const LockFolder folder;
  const DeviceLock used("drm-A");
  { const DeviceLock free("drm-B"); }
  const std::string file = folder.path + "/vam-drm-B.lock";
  std::ofstream(file) << "1\n";
  CHECK(device::locked_names("drm-") == std::vector<std::string>{"drm-A"});
  std::string line;
  std::getline(std::ifstream(file), line);
  CHECK(line == "1");
  const pid_t lister = fork();
  while (lister == 0) (void)device::locked_names("drm-");
  for (int trial = 0; trial < 300; ++trial) CHECK_FALSE(fault_of([] { DeviceLock("drm-B"); }).has_value());
  kill(lister, SIGKILL);
  waitpid(lister, nullptr, 0);
}

TEST_CASE("Two names of one device node are one device") {
  const LockFolder folder;
  const std::string link = folder.path + "/by-id";
  std::filesystem::create_symlink("/dev/zero", link);
  const DeviceLock lock(link);
  CHECK(fault_of([] { DeviceLock("/dev/zero"); }) == Fault::busy);
  CHECK_FALSE(fault_of([] { DeviceLock("/dev/null"); }).has_value());
}

TEST_CASE("A missing folder cannot hold locks") {
  const LockFolder folder;
  setenv("VAM_LOCK_DIR", "/nonexistent", 1);
  CHECK(fault_of([] { DeviceLock("usb-1"); }) == Fault::no_output);
}

TEST_CASE("A device node is free, in use by a process, or not there") {
  const LockFolder folder;
  CHECK(device::node_obstacle("/dev/null").empty());
  CHECK(has(device::node_obstacle(folder.path + "/none"), "/none: No such file or directory"));
  const DeviceLock lock("/dev/null");
  CHECK(has(device::node_obstacle("/dev/null"), "in use by process " + std::to_string(getpid())));
  CHECK(has(device::lock_obstacle("/dev/null"), "in use by process " + std::to_string(getpid())));
  CHECK(device::lock_obstacle("/dev/zero").empty());
}

TEST_CASE("To a user who may not use a device node its group is named, or a rule where the group is root's") {
  if (geteuid() != 0) return;  // who alone can be somebody else
  const LockFolder folder;
  const group* dialout = getgrnam("dialout");
  REQUIRE(dialout != nullptr);
  const std::string node = folder.path + "/node";
  std::ofstream(node) << "x";
  REQUIRE(chmod(folder.path.c_str(), 0755) == 0);
  const auto seen = [&](gid_t owner, mode_t mode) {
    REQUIRE(chown(node.c_str(), 0, owner) == 0);
    REQUIRE(chmod(node.c_str(), mode) == 0);
    return obstacle_for_nobody(node);
  };
  const std::string rule = "not permitted to this user; add a udev rule with TAG+=\"uaccess\"";
  CHECK(seen(dialout->gr_gid, 0660) ==
        "not permitted to this user; run `sudo usermod -aG dialout $USER` and log in again");
  CHECK(seen(dialout->gr_gid, 0640) == rule);  // who joins it may still not write
  CHECK(seen(0, 0660) == rule);
}
