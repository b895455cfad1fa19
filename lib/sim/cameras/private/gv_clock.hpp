// SPDX-License-Identifier: GPL-3.0-or-later
// The clock of a simulated GigE Vision camera, with its latch.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

namespace vam::sim {

/// Runs from power-on (GigE Vision: the counter starts at 0 at a reset) in ns, 30 ppm fast.
class GvClock {
 public:
  /// GenICam nodes of the latch (GevTimestampControlLatch, GevTimestampValue) on the standard's bootstrap registers.
  [[nodiscard]] static std::string nodes();
  using Read = std::function<unsigned(unsigned place)>;
  using Write = std::function<void(unsigned place, const std::string& bytes)>;

  /// Of these registers, big-endian. Latches the time in a thread of its own whenever a client asks for it.
  GvClock(Read read, Write write);
  ~GvClock();
  GvClock(const GvClock&) = delete;
  GvClock& operator=(const GvClock&) = delete;
  /// What the clock shows at a time of CLOCK_MONOTONIC.
  [[nodiscard]] std::uint64_t ns(double monotonic_s) const;

 private:
  void serve();

  Read read_;
  Write write_;
  double start_s_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace vam::sim
