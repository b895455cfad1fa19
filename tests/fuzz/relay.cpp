// SPDX-License-Identifier: GPL-3.0-or-later
// The answers of a relay, before and during a print.
#include "device/safety/relay.hpp"

#include "base/text/json.hpp"
#include "device/os/clock.hpp"
#include "fuzz/answers.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  vam::device::VirtualClock clock;
  return fuzz::attempt([&] {
    vam::device::Relay relay(std::make_unique<fuzz::Answers>(fuzz::text_of(bytes, size), clock), clock, nullptr);
    (void)relay.identify().dump();
    relay.close();
    for (int beat = 0; beat < 20; ++beat) {
      clock.sleep_until(clock.now_s() + 0.03);
      relay.beat();
    }
    relay.open();
  });
}
