// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/interrupt.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "testing.hpp"

using namespace vam;

namespace {

// What a tool writes that ends with its parent: 'b' once that is agreed, 'o' where it goes on without a parent, 'r'
// where another process than the first adopts orphans. The parent ends before that or after.
std::string said_by_orphan(bool parent_first) {
  std::array<int, 2> line{};
  std::array<int, 2> end{};
  REQUIRE(pipe(line.data()) == 0);
  REQUIRE(pipe(end.data()) == 0);
  const pid_t parent = fork();
  if (parent == 0) {
    const pid_t own = getpid();
    if (fork() == 0) {
      std::signal(SIGTERM, SIG_DFL);  // doctest catches it
      while (parent_first && getppid() == own) usleep(1000);
      if (parent_first && getppid() != 1) {
        (void)!write(line[1], "r", 1);
        _exit(0);
      }
      device::end_with_parent();
      (void)!write(line[1], "b", 1);
      (void)!write(end[1], "x", 1);
      while (getppid() == own) usleep(1000);
      usleep(200000);
      (void)!write(line[1], "o", 1);
      _exit(0);
    }
    close(end[1]);
    char byte = 0;
    if (!parent_first) (void)!read(end[0], &byte, 1);
    _exit(0);
  }
  close(line[1]);
  close(end[1]);
  waitpid(parent, nullptr, 0);
  std::string said;
  for (char byte = 0; read(line[0], &byte, 1) == 1;) said += byte;
  close(line[0]);
  close(end[0]);
  return said;
}

}  // namespace

TEST_CASE("A tool that is to end with its parent does, also where that has ended before") {
  CHECK(said_by_orphan(false) == "b");
  const std::string late = said_by_orphan(true);
  CHECK((late.empty() || late == "r"));
}
