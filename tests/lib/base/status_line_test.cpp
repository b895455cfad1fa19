// SPDX-License-Identifier: GPL-3.0-or-later
// The line of progress on a terminal, which a child of this process writes to.
#include "base/log/status_line.hpp"

#include <fcntl.h>
#include <pty.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

const std::string cleared = "\r\033[K";

/// A terminal of 60 columns.
class Terminal {
 public:
  Terminal() {
    std::array<char, 64> name{};
    const winsize size{24, 60, 0, 0};
    REQUIRE(openpty(&leader_, &terminal_, name.data(), nullptr, &size) == 0);
    REQUIRE(fcntl(leader_, F_SETFL, O_NONBLOCK) == 0);
    name_ = name.data();
  }
  ~Terminal() {
    close(leader_);
    close(terminal_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }

  /// What a process prints whose standard error it is.
  [[nodiscard]] std::string shows(const std::function<void()>& work) const {
    const pid_t child = fork();
    if (child == 0) {
      dup2(terminal_, STDERR_FILENO);
      work();
      _exit(0);
    }
    int status = -1;
    waitpid(child, &status, 0);
    CHECK(status == 0);
    std::string text(4096, '\0');
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(read(leader_, text.data(), text.size()), 0)));
    return text;
  }

 private:
  int leader_ = -1, terminal_ = -1;
  std::string name_;
};

void work_for_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

}  // namespace

TEST_CASE("a message clears the line that is shown, and nothing where there is none") {
  const Terminal terminal;
  CHECK(terminal.shows([] { status_line::make_way(); }).empty());
  CHECK(terminal.shows([] {
    status_line::show("half");
    status_line::make_way();
  }) == "\rhalf\033[K" + cleared);
  CHECK(terminal.shows([] {
    status_line::show("half");
    status_line::hide();
    status_line::make_way();
    status_line::show("whole");
  }) == "\rhalf\033[K" + cleared + "\rwhole\033[K");
}

TEST_CASE("while another program's line is shown there is no second one, and a message clears the first") {
  const Terminal terminal;
  const int other = open(terminal.name().c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  REQUIRE(flock(other, LOCK_EX | LOCK_NB) == 0);
  CHECK(terminal.shows([] {
    status_line::show("mine");
    status_line::hide();
    status_line::make_way();
  }) == cleared);
  close(other);
  CHECK(terminal.shows([] { status_line::show("mine"); }) == "\rmine\033[K");
}

TEST_CASE("a line is cut at the width of the terminal") {
  const Terminal terminal;
  CHECK(terminal.shows([] { status_line::show(std::string(100, 'x')); }) == "\r" + std::string(59, 'x') + "\033[K");
}

TEST_CASE("progress is shown after half a second, with a bar where the end is known") {
  const Terminal terminal;
  CHECK(terminal.shows([] { Progress("slicing", 8).tick(4); }).empty());
  const std::string known = terminal.shows([] {
    Progress progress("slicing", 8);
    work_for_ms(510);
    progress.tick(4);
  });
  const std::size_t bar = 59 - std::string("vam: slicing [] 50 %, 0:01 left").size();
  CHECK(known.substr(0, 1 + 14) == "\rvam: slicing [");
  CHECK(known.find(std::string(bar / 2, '#') + std::string(bar - bar / 2, ' ') + "] 50 %, ") == 1 + 14);
  CHECK(known.size() == 1 + 59 + 3 + cleared.size());
  CHECK(known.ends_with(" left\033[K" + cleared));
  CHECK(terminal.shows([] {
    Progress progress("reading", 0);
    work_for_ms(510);
    progress.tick(3);
  }) == "\rvam: reading 3\033[K" + cleared);
}
