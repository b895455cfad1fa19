// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/cameras/private/gv_clock.hpp"

#include <chrono>
#include <cmath>
#include <utility>

#include "device/camera/camera.hpp"

namespace vam::sim {

namespace {
constexpr double drift = 3e-5;
constexpr double before_s = 100;  // it was switched on; so that nothing is before that
constexpr unsigned control_register = 0x0944, latch_bit = 2;
constexpr unsigned value_register = 0x0948;
constexpr int restless_ms = 1000;  // so long after a latch another one is expected
constexpr auto short_while = std::chrono::microseconds(200), long_while = std::chrono::microseconds(4000);
}  // namespace

std::string GvClock::nodes() {
  const auto integer = [](const char* name, const char* address, int bytes, const char* mode) {
    return std::string("<IntReg Name=\"") + name + "\"><Address>" + address + "</Address><Length>" +
           std::to_string(bytes) + "</Length><AccessMode>" + mode +
           "</AccessMode><pPort>Device</pPort><Cachable>NoCache</Cachable><Sign>Unsigned</Sign>"
           "<Endianess>BigEndian</Endianess></IntReg>\n";
  };
  return integer("TimestampControlRegister", "0x944", 4, "RW") + integer("GevTimestampValue", "0x948", 8, "RO") +
         "<Command Name=\"GevTimestampControlLatch\"><pValue>TimestampControlRegister</pValue>"
         "<CommandValue>2</CommandValue></Command>\n";
}

GvClock::GvClock(Read read, Write write)
    : read_(std::move(read)),
      write_(std::move(write)),
      start_s_(device::real_clock().now_s() - before_s),
      thread_([this] { serve(); }) {}

GvClock::~GvClock() {
  ended_ = true;
  thread_.join();
}

std::uint64_t GvClock::ns(double monotonic_s) const {
  return static_cast<std::uint64_t>(std::llround(1e9 * (1 + drift) * (monotonic_s - start_s_)));
}

void GvClock::serve() {
  double latched_s = 0;
  while (!ended_) {
    if (read_(control_register) == latch_bit) {
      latched_s = device::real_clock().now_s();
      std::string value;
      for (int shift = 56; shift >= 0; shift -= 8) value += static_cast<char>(ns(latched_s) >> shift & 255U);
      write_(control_register, std::string(4, '\0'));
      write_(value_register, value);  // in one piece
    }
    const bool restless = device::real_clock().now_s() < latched_s + 1e-3 * restless_ms;
    std::this_thread::sleep_for(restless ? short_while : long_while);
  }
}

}  // namespace vam::sim
