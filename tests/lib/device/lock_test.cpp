#include "device/os/lock.hpp"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "base/error.hpp"
#include "fault_of.hpp"

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

}  // namespace

TEST_CASE("The second user learns who the first one is; kill -9 frees the device") {
  const LockFolder folder;
  const pid_t first = holder("/dev/null");
  CHECK(fault_of([] { DeviceLock("/dev/null"); }) == Fault::busy);
  const std::string message = message_of([] { DeviceLock("/dev/null"); });
  CHECK(message.find("process " + std::to_string(first)) != std::string::npos);
  kill(first, SIGKILL);
  waitpid(first, nullptr, 0);
  CHECK_FALSE(fault_of([] { DeviceLock("/dev/null"); }).has_value());
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
