// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/log/status_line.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <mutex>

namespace vam::status_line {

namespace {

constexpr int usual_columns = 80;
constexpr const char* cleared = "\r\033[K";

/// A lock on the terminal, by which processes know whose line is shown. stderr itself is one open file for all tools
/// of a pipe, so that a lock on it would be everybody's.
class Turn {
 public:
  /// False where it is another's.
  bool take() {
    if (taken_) return true;
    open();
    taken_ = descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    return taken_;
  }
  void leave() {
    if (taken_ && descriptor_ >= 0) flock(descriptor_, LOCK_UN);
    taken_ = false;
  }
  [[nodiscard]] bool taken() const { return taken_; }

 private:
  void open() {
    if (opened_) return;
    opened_ = true;
    std::array<char, 64> name{};
    if (ttyname_r(STDERR_FILENO, name.data(), name.size()) != 0) return;
    descriptor_ = ::open(name.data(), O_WRONLY | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
  }
  int descriptor_ = -1;  // none: nobody to share with
  bool opened_ = false, taken_ = false;
};

Turn turn;          // NOLINT: one per process
std::mutex access;  // NOLINT: to it

}  // namespace

bool possible() { return isatty(STDERR_FILENO) == 1; }

int width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return (known ? size.ws_col : usual_columns) - 1;
}

void show(const std::string& text) {
  const std::scoped_lock one(access);
  if (!turn.take()) return;
  std::fprintf(stderr, "\r%.*s\033[K", width(), text.c_str());
}

void hide() {
  const std::scoped_lock one(access);
  if (turn.taken()) std::fputs(cleared, stderr);
  turn.leave();
}

void make_way() {
  if (!possible()) return;
  const std::scoped_lock one(access);
  const bool own = turn.taken();
  if (own || !turn.take()) {
    std::fputs(cleared, stderr);
  } else {
    turn.leave();
  }
}

}  // namespace vam::status_line
