// SPDX-License-Identifier: GPL-3.0-or-later
// TI DLPC350 (LightCrafter 4500) and DLPC900 (LightCrafter 6500 and 9000) as light engines.
// Source: TI DLPU010 and DLPU018, "Programmer's Guide"; for the inverted current of the LightCrafter 4500 TI's forum,
// thread 451589, and what TI's own LightCrafter 4500 GUI sends: 255 less the current, at normal polarity.
#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/os/clock.hpp"
#include "device/os/identity.hpp"
#include "device/port/usb_kinds.hpp"
#include "device/projector/light_engine.hpp"
#include "device/projector/private/dlp_link.hpp"
#include "device/safety/guardian_actions.hpp"
#include "device/safety/stop_order.hpp"

namespace vam::device {

namespace {

using enum DlpCommand;

constexpr double patience_s = 15;  // to wake, to find the image
constexpr double mode_s = 2;       // to take up a mode: some tenths of a second
constexpr int asleep = 1;
constexpr int from_video_port = 0;
constexpr int from_hdmi = 1;
constexpr int video_mode = 0;
constexpr int video_pattern_mode = 2;
constexpr int stop = 0;
constexpr int start = 2;
constexpr int sequencer_runs = 1 << 1;  // of the main status
constexpr int signal_found = 1 << 3;    // of the main status, DLPC900
// Three of them and the 105 us of black before the next frame fit in a frame of 60 Hz.
constexpr int pattern_us = 5500;
constexpr int full_current = 255;
constexpr int normal_polarity = 0;

std::string in_percent(double percent) { return format_number(std::round(10 * percent) / 10) + " %"; }

void unless_refused(const std::function<void()>& words) {
  try {
    words();
  } catch (const Error& error) {
    if (error.fault != Fault::protocol) throw;
  }
}

class DlpLight final : public LightEngine {
 public:
  DlpLight(std::unique_ptr<UsbLink> usb, const LightSettings& settings, Clock& clock, Guardian* guardian)
      : link_(std::move(usb), clock, guardian), settings_(settings), order_(guardian) {
    if (settings.current_percent.value_or(0) > settings.max_current_percent) {
      throw Error{Fault::usage,
                  link_.name() + ": current of " + in_percent(*settings.current_percent) + " is above the limit of " +
                      in_percent(settings.max_current_percent) +
                      "; lower current_percent, or raise the limit (projector.max_led_current_percent, and "
                      "max_current_percent of the device) within the rating of the LEDs"};
    }
    if (settings.leds.empty()) throw Error{Fault::usage, link_.name() + ": leds= names no LED; give any of r, g and b"};
    for (const char led : settings.leds) {
      const std::size_t bit = std::string("rgb").find(led);
      if (bit == std::string::npos)
        throw Error{Fault::usage, link_.name() + ": leds=" + settings.leds + " must consist of r, g and b"};
      led_bits_ |= 1 << bit;
    }
  }

  ~DlpLight() override {
    if (!awake_) return;
    try {
      standby();
    } catch (...) {
      // The guardian still holds the order.
    }
  }

  Json identify() override {
    Json about = link_.about();
    const DlpBytes version = link_.ask(firmware, 4);
    about["firmware"] = std::to_string(version[3]) + "." + std::to_string(version[2]) + "." +
                        std::to_string(version[0] + 256 * version[1]);
    about["hardware_status"] = link_.ask(hardware_status);
    about["system_status"] = link_.ask(system_status);
    about["main_status"] = link_.ask(main_status);
    about["led_current_percent"] = currents_percent();
    return with_mark(about);
  }

  void prepare() override {
    wake();
    link_.set(led_enable, {0}, "LED enable");
    stop_patterns();
    link_.set(display_mode, {video_mode}, "video mode", mode_s);
    link_.set(input_source, {(link_.ask(input_source) & ~7) | from_video_port}, "input from the video port");
    // Grey must be linear: the host's own table makes the intensity.
    if (dlpc900()) {
      show_patterns();
    } else {
      link_.set(gamma, {link_.ask(gamma) & 0x7F}, "gamma off");  // whatever its number
    }
    if (settings_.current_percent) {
      link_.set(led_polarity, {normal_polarity}, "LED polarity");
      const int steps = floor_int(*settings_.current_percent / 100 * full_current);
      link_.set(led_current, DlpBytes(3, dlpc900() ? steps : full_current - steps), "LED current");
    }
    require_capped(currents_percent());
    if ((link_.ask(hardware_status) & 1) == 0) {
      throw Error{Fault::protocol, link_.name() + ": start-up self-test failed; switch it off and on"};
    }
  }

  void on() override {
    watch();
    link_.set(led_enable, {led_bits_}, "LED enable");
  }

  void dark() override {
    link_.set(led_enable, {0}, "LED enable");
    order_.withdraw();
  }

  // Asleep it is dark, too: an engine that does not confirm the first is told the second.
  void standby() override {
    std::exception_ptr lit;
    try {
      dark();
    } catch (const Error&) {
      lit = std::current_exception();
    }
    stop_patterns();
    link_.tell(power, {asleep});
    awake_ = false;
    if (lit) std::rethrow_exception(lit);
  }

 private:
  // The engine answers while it wakes, but is not awake at once.
  void wake() {
    awake_ = true;
    link_.tell(power, {0});
    require_soon([&] { return link_.ask(power) == 0; }, "does not leave standby", "switch it off and on");
  }

  void stop_patterns() {
    unless_refused([&] { link_.tell(pattern_start_stop, {stop}); });  // when there are none
  }

  // The gamma of a DLPC900 cannot be switched off. Its grey is linear where it takes a frame for three patterns of 8
  // bits, its colours one after the other, which it does only with an image that it has found.
  void show_patterns() {
    unless_refused([&] {  // by a board without a receiver
      if (link_.ask(video_receiver) == 0) link_.tell(video_receiver, {from_hdmi});
    });
    require_soon([&] { return (link_.ask(main_status) & signal_found) != 0; }, "finds no video signal at its input",
                 "check the video cable and the screen mode");
    link_.set(display_mode, {video_pattern_mode}, "video pattern mode", mode_s);
    for (int colour = 0; colour < 3; ++colour) {
      const int begins_with_frame = colour == 0 ? 0x80 : 0;
      const int first_bit = 8 * colour;
      link_.tell(pattern, {colour, 0, pattern_us & 0xFF, pattern_us >> 8, 0,
                           begins_with_frame | led_bits_ << 4 | (8 - 1) << 1, 0, 0, 0, 0, 0, first_bit << 3});
    }
    link_.tell(pattern_table, {3, 0, 0, 0, 0, 0});  // all three, for ever
    link_.tell(pattern_start_stop, {start});
    require_soon([&] { return (link_.ask(main_status) & sequencer_runs) != 0; }, "does not start its pattern sequence",
                 "check the screen mode: at most 60 Hz");
  }

  void require_soon(const std::function<bool()>& done, const std::string& problem, const std::string& remedy) {
    if (link_.within(patience_s, done)) return;
    throw Error{Fault::busy, link_.name() + ": " + problem + " within " + format_number(patience_s) + " s; " + remedy};
  }

  [[nodiscard]] bool dlpc900() const {
    const UsbKind& kind = usb_kind("dlpc900");
    return link_.about()["usb_id"] == ids_text(kind.vendor, kind.products.front());
  }

  // Of red, green and blue. The drivers of a LightCrafter 4500 invert what its DLPC350 puts out, whose polarity may be
  // inverted in turn.
  std::vector<double> currents_percent() {
    const bool inverted = (link_.ask(led_polarity) & 1) != normal_polarity;
    std::vector<double> percent;
    for (const int byte : link_.ask(led_current, 3)) {
      percent.push_back(100.0 / full_current * (inverted == dlpc900() ? full_current - byte : byte));
    }
    return percent;
  }

  void require_capped(const std::vector<double>& currents) const {
    for (std::size_t led = 0; led < 3; ++led) {
      if ((led_bits_ >> led & 1) == 0 || currents[led] <= settings_.max_current_percent) continue;
      throw Error{Fault::protocol, link_.name() + ": LED current is " + in_percent(currents[led]) +
                                       ", above the limit of " + in_percent(settings_.max_current_percent) +
                                       "; give current_percent=N"};
    }
  }

  void watch() {
    const Json about = link_.about();
    // Flags 0: no acknowledgement, since no process is left to read it.
    const Json reports =
        Json::array({to_hex(dlp_report(0, 0, led_enable, {0})), to_hex(dlp_report(0, 1, pattern_start_stop, {stop})),
                     to_hex(dlp_report(0, 2, power, {asleep}))});
    order_.give({{"do", "usb"},
                 {"order", 0},
                 {"name", "light"},
                 {"usb_id", about["usb_id"]},
                 {"serial", about["serial"]},
                 {"interface", 0},
                 {"reports", reports}});
  }

  DlpLink link_;
  LightSettings settings_;
  StopOrder order_;
  int led_bits_ = 0;
  bool awake_ = false;
};

}  // namespace

std::unique_ptr<LightEngine> make_dlp_light(std::unique_ptr<UsbLink> link, const LightSettings& settings, Clock& clock,
                                            Guardian* guardian) {
  return std::make_unique<DlpLight>(std::move(link), settings, clock, guardian);
}

}  // namespace vam::device
