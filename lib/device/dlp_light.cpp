// TI DLPC350 (LightCrafter 4500) and DLPC900 (LightCrafter 6500 and 9000) over USB HID.
// Source: TI DLPU010 and DLPU018, "Programmer's Guide".
#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "base/error.hpp"
#include "base/text.hpp"
#include "device/address.hpp"
#include "device/clock.hpp"
#include "device/guardian_actions.hpp"
#include "device/light_engine.hpp"
#include "device/sim_dlp.hpp"

namespace vam::device {

namespace {

// Commands as CMD2, CMD3.
enum Command : unsigned {
  power = 0x0200,
  firmware = 0x0205,
  led_current = 0x0B01,
  input_source = 0x1A00,
  led_enable = 0x1A07,
  hardware_status = 0x1A0A,
  system_status = 0x1A0B,
  main_status = 0x1A0C,
  gamma = 0x1A0E,
  display_mode = 0x1A1B,
  pattern_start_stop = 0x1A24,
};
constexpr unsigned char write_and_acknowledge = 0x40;
constexpr unsigned char read_request = 0xC0;
constexpr unsigned char not_acknowledged = 0x20;
constexpr std::size_t header_bytes = 4;
constexpr double wake_s = 10;

// flags, sequence, length (little endian, of command and data), CMD3, CMD2, data
std::string report(unsigned char flags, unsigned char sequence, Command command, const std::string& data) {
  std::string bytes;
  bytes += static_cast<char>(flags);
  bytes += static_cast<char>(sequence);
  bytes += static_cast<char>(2 + data.size());
  bytes += '\0';
  bytes += static_cast<char>(command & 0xFFU);
  bytes += static_cast<char>(command >> 8U);
  return bytes + data;
}

class DlpLight final : public LightEngine {
 public:
  DlpLight(std::unique_ptr<UsbLink> link, const LightSettings& settings, Guardian* guardian)
      : link_(std::move(link)), settings_(settings), guardian_(guardian) {
    if (settings.current.value_or(0) > settings.max_current) {
      throw Error{Fault::usage, link_->name() + ": current " + std::to_string(*settings.current) +
                                    " is above the cap of " + std::to_string(settings.max_current) +
                                    "; raise projector.max_led_current only within what the LEDs bear"};
    }
    for (const char led : settings.leds) {
      const std::size_t bit = std::string("rgb").find(led);
      if (bit == std::string::npos)
        throw Error{Fault::usage, link_->name() + ": leds=" + settings.leds + " is not made of r, g and b"};
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
    Json about = link_->about();
    const std::string version = ask(firmware, 4);
    about["firmware"] = std::to_string(byte(version, 3)) + "." + std::to_string(byte(version, 2)) + "." +
                        std::to_string(byte(version, 0) + 256 * byte(version, 1));
    about["hardware_status"] = byte(ask(hardware_status, 1), 0);
    about["system_status"] = byte(ask(system_status, 1), 0);
    about["main_status"] = byte(ask(main_status, 1), 0);
    return about;
  }

  void prepare() override {
    wake();
    set(led_enable, std::string(1, '\0'), "LED enable");
    set(display_mode, std::string(1, '\0'), "video mode");
    const std::string source = ask(input_source, 1);
    set(input_source, std::string(1, static_cast<char>(byte(source, 0) & ~7)), "input from the video port");
    // Grey must be linear: the host's own table makes the intensity, so the engine's gamma is off, whatever its number.
    const std::string table = ask(gamma, 1);
    set(gamma, std::string(1, static_cast<char>(byte(table, 0) & 0x7F)), "gamma off");
    if (settings_.current) {
      set(led_current, std::string(3, static_cast<char>(*settings_.current)), "LED current");
    } else {
      require_capped(ask(led_current, 3));
    }
    if ((byte(ask(hardware_status, 1), 0) & 1) == 0) {
      throw Error{Fault::protocol, link_->name() + ": its own start-up check failed; switch it off and on again"};
    }
  }

  void on() override {
    watch();
    set(led_enable, std::string(1, static_cast<char>(led_bits_)), "LED enable");
  }

  void dark() override {
    set(led_enable, std::string(1, '\0'), "LED enable");
    if (action_) guardian_->forget(*action_);
    action_.reset();
  }

  void standby() override {
    dark();
    try {
      tell(pattern_start_stop, std::string(1, '\0'));
    } catch (const Error& error) {
      if (error.fault != Fault::protocol) throw;  // refused: there is no pattern to stop in video mode
    }
    tell(power, std::string(1, '\1'));
    awake_ = false;
  }

 private:
  static int byte(const std::string& bytes, std::size_t i) { return static_cast<unsigned char>(bytes.at(i)); }

  std::string exchange(unsigned char flags, Command command, const std::string& data) {
    link_->write_report(report(flags, ++sequence_, command, data));
    // An answer to an older question may still be under way; its sequence number tells.
    for (int attempt = 0; attempt < 4; ++attempt) {
      const std::string answer = link_->read_report();
      if (answer.size() < header_bytes) break;
      if (static_cast<unsigned char>(answer[1]) != sequence_) continue;
      if ((static_cast<unsigned char>(answer[0]) & not_acknowledged) != 0) throw wrong(command, "refused");
      const auto length = static_cast<std::size_t>(byte(answer, 2)) + 256 * static_cast<std::size_t>(byte(answer, 3));
      if (header_bytes + length > answer.size())
        throw wrong(command, "answered with a length of " + std::to_string(length));
      if (guardian_ != nullptr) guardian_->beat();
      return answer.substr(header_bytes, length);
    }
    throw wrong(command, "not answered, but something else was");
  }

  Error wrong(Command command, const std::string& what) const {
    std::array<char, 24> name{};
    std::snprintf(name.data(), name.size(), "command %02X %02X", command >> 8U, command & 0xFFU);
    return {Fault::protocol, link_->name() + ": " + name.data() + " was " + what};
  }

  // The engine answers while it wakes, but is not awake at once.
  void wake() {
    awake_ = true;
    tell(power, std::string(1, '\0'));
    const double limit_s = real_clock().now_s() + wake_s;
    while (byte(ask(power, 1), 0) != 0) {
      if (real_clock().now_s() > limit_s) {
        throw Error{Fault::busy, link_->name() + ": does not wake within " + format_number(wake_s) + " s"};
      }
      real_clock().sleep_until(real_clock().now_s() + 0.02);
    }
  }

  void tell(Command command, const std::string& data) { (void)exchange(write_and_acknowledge, command, data); }

  std::string ask(Command command, std::size_t bytes) {
    const std::string data = exchange(read_request, command, "");
    if (data.size() < bytes) throw wrong(command, "answered with " + std::to_string(data.size()) + " bytes");
    return data.substr(0, bytes);
  }

  // Writes a setting and reads it back: what shines must be what was asked for.
  void set(Command command, const std::string& data, const std::string& what) {
    tell(command, data);
    const std::string back = ask(command, data.size());
    if (back == data) return;
    throw Error{Fault::protocol,
                link_->name() + ": " + what + " was set to " + to_hex(data) + " but reads back as " + to_hex(back)};
  }

  void require_capped(const std::string& currents) const {
    for (std::size_t led = 0; led < 3; ++led) {
      if ((led_bits_ >> led & 1) == 0 || byte(currents, led) <= settings_.max_current) continue;
      throw Error{Fault::protocol, link_->name() + ": its current is " + std::to_string(byte(currents, led)) +
                                       ", above the cap of " + std::to_string(settings_.max_current) +
                                       "; give current=N"};
    }
  }

  void watch() {
    if (guardian_ == nullptr || action_) return;
    const Json about = link_->about();
    // Flags 0: no acknowledgement, since nobody is left to read it.
    Json reports = Json::array({to_hex(report(0, 0, led_enable, std::string(1, '\0')))});
    reports.push_back(to_hex(report(0, 1, pattern_start_stop, std::string(1, '\0'))));
    reports.push_back(to_hex(report(0, 2, power, std::string(1, '\1'))));
    action_ = guardian_->add({{"do", "usb"},
                              {"order", 0},
                              {"name", "light"},
                              {"usb_id", about["usb_id"]},
                              {"serial", about["serial"]},
                              {"interface", 0},
                              {"reports", reports}});
  }

  std::unique_ptr<UsbLink> link_;
  LightSettings settings_;
  Guardian* guardian_;
  int led_bits_ = 0;
  bool awake_ = false;
  unsigned char sequence_ = 0;
  std::optional<int> action_;
};

}  // namespace

std::unique_ptr<LightEngine> make_dlp_light(std::unique_ptr<UsbLink> link, const LightSettings& settings,
                                            Guardian* guardian) {
  return std::make_unique<DlpLight>(std::move(link), settings, guardian);
}

std::unique_ptr<LightEngine> open_light(const std::string& device, int max_current, Guardian* guardian) {
  const Address address = parse_address(device, {"sim", "dlpc350", "dlpc900"});
  LightSettings settings;
  settings.current = address.integer("current", 0, 255);
  settings.max_current = std::min(max_current, address.integer("max_current", 0, 255).value_or(max_current));
  settings.leds = address.word("leds", settings.leds);
  if (address.scheme == "sim") {
    address.allow({"current", "max_current", "leds", "log"});
    return make_dlp_light(make_sim_dlp({}, file_sim_log(address.word("log", ""))), settings, nullptr);
  }
  address.allow({"current", "max_current", "leds"});
  auto link = open_usb({0x0451, {address.scheme == "dlpc900" ? 0xC900 : 0x6401}, address.place}, 0);
  auto lock = std::make_unique<DeviceLock>(link->name());
  if (guardian != nullptr) guardian->keep(lock->handle());
  auto light = make_dlp_light(std::move(link), settings, guardian);
  light->hold(std::move(lock));
  return light;
}

}  // namespace vam::device
