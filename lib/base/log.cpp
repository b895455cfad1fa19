#include "base/log.hpp"

#include <unistd.h>

#include <cstdio>
#include <utility>

#include "base/printable.hpp"

namespace vam {

namespace {
std::string program = "vam";  // NOLINT: one per process
constexpr long first_draw_ms = 500;
constexpr long redraw_ms = 100;
constexpr int bar_width = 30;
}  // namespace

void set_program_name(const std::string& name) { program = name; }

void warn(const std::string& line) {
  std::fprintf(stderr, "%s: warning: %s\n", program.c_str(), printable(line).c_str());
}

void note(const std::string& line) {
  if (isatty(STDERR_FILENO) == 1) std::fprintf(stderr, "%s\n", printable(line).c_str());
}

Progress::Progress(std::string what, long total)
    : what_(std::move(what)),
      total_(total),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
  if (drawn_ms_ > 0) std::fputs("\r\033[K", stderr);
}

void Progress::tick(long steps) {
  const long done = done_ += steps;
  if (!terminal_) return;
  const auto elapsed = std::chrono::steady_clock::now() - start_;
  const long now_ms = static_cast<long>(std::chrono::duration_cast<std::chrono::milliseconds>(elapsed).count());
  long last = drawn_ms_;
  if (now_ms < (last == 0 ? first_draw_ms : last + redraw_ms)) return;
  if (drawn_ms_.compare_exchange_strong(last, now_ms)) draw(done);
}

void Progress::draw(long done) {
  const double part = total_ > 0 ? static_cast<double>(done) / static_cast<double>(total_) : 0.0;
  const int filled = static_cast<int>(part * bar_width);
  const double spent_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double left_s = part > 0 ? spent_s * (1 - part) / part : 0;
  std::fprintf(stderr, "\r%s: %s [%.*s%*s] %3.0f %%, %.0f s left\033[K", program.c_str(), what_.c_str(), filled,
               "##############################", bar_width - filled, "", part * 100, left_s);
}

}  // namespace vam
