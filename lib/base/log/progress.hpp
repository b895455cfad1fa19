// SPDX-License-Identifier: GPL-3.0-or-later
// Where long work stands: a line on the terminal, or lines of JSON, on stderr (base/log/log.hpp: Talk).
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace vam {

/// A figure of the work beside how far it is: {"VER", 0.012}, of which JSON has "ver".
struct Figure {
  const char* name;
  double value;
};

/// Shown from half a second on: share done, time left if it goes on as it did, figures.
class Progress {
 public:
  /// what: "slicing"; total: steps, 0 where not known.
  Progress(std::string what, long total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// From any thread.
  void tick(long steps = 1);
  /// From one thread: steps done, of how many as far as is known now.
  void set_progress(long done, long total, std::vector<Figure> figures);

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] double elapsed_s() const;
  void refresh(long done);
  void draw(long done);
  [[nodiscard]] std::string line(long done, int width) const;
  void print_json(long done, std::optional<double> left_s, bool finished) const;
  std::string what_;
  std::atomic<long> total_, done_{0}, drawn_ms_{0};
  Clock::time_point start_ = Clock::now();
  std::mutex drawing_;
  std::vector<Figure> figures_;
};

/// "0:05", "12:40", "1:02:40".
[[nodiscard]] std::string clock_text(double seconds);

}  // namespace vam
