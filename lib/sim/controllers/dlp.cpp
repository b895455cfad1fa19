// SPDX-License-Identifier: GPL-3.0-or-later
// Sources, named beside each behaviour by the name of the command: Texas Instruments' DLPC350 Programmer's Guide
// (DLPU010) and DLPC900 Programmer's Guide (DLPU018). For what guide and board disagree about: TI forum, thread 451589.
// Public drivers that send the same bytes: pyCrafter4500 (github.com/SivyerLab/pyCrafter4500).
#include "sim/controllers/dlp.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "device/os/clock.hpp"

namespace vam::sim {

namespace {

class SimDlp final : public device::UsbLink {
 public:
  SimDlp(const SimDlpSettings& settings, SimLog log) : settings_(settings), log_(std::move(log)) {
    name_ = settings.dlpc900 ? "sim: (LightCrafter 6500)" : "sim: (LightCrafter 4500)";
    registers_[0x0200] = std::string(1, '\1');  // Power Control: standby
    // Retrieve Firmware Version: four numbers, the least significant byte first.
    registers_[0x0205] = std::string("\x01\x00\x00\x04", 4) + std::string(12, '\0');
    // LED PWM Polarity: 0 normal, 1 inverted.
    registers_[0x1A05] = std::string(1, settings.inverted ? '\1' : '\0');
    // LED Driver Current Control: red, green, blue; by the guide 255 is full at normal polarity, which a DLPC900 does
    // and the drivers of a LightCrafter 4500 turn round (thread 451589).
    const double share = settings.current_percent / 100;
    const bool upside_down = settings.inverted != !settings.dlpc900;
    registers_[0x0B01].assign(3, static_cast<char>(std::lround(255 * (upside_down ? 1 - share : share))));
    // Input Source Selection; the status commands Hardware (bit 0: initialised), System, Main (bit 1: sequencer runs);
    // Display Mode: 0 video, 1 pattern (DLPC350), 2 video pattern (DLPC900); Pattern Display Start/Stop.
    registers_[0x1A00] = std::string(1, '\x0A');
    registers_[0x1A07] = std::string(1, '\x08');  // LED Enable Outputs: bit 3, by the sequencer
    registers_[0x1A0A] = std::string(1, '\x01');
    registers_[0x1A0B] = std::string(1, '\x01');
    registers_[0x1A0C] = std::string(1, '\x02');
    registers_[0x1A1B] = std::string(1, '\x01');
    registers_[0x1A24] = std::string(1, '\x00');
    if (settings.dlpc900) {
      registers_[0x1A01] = std::string(1, '\x00');  // Port and Clock / IT6535 Power Mode: receiver off
      registers_[0x1A31] = std::string(6, '\0');    // table of patterns
      registers_[0x1A34] = std::string(12, '\0');   // the pattern set last
    } else {
      registers_[0x1A0E] = std::string(1, '\x80');  // Gamma Correction: bit 7, on as delivered
    }
    for (const int command : {0x0200, 0x1A0C, 0x1A1B}) slow_[command] = settings.slow_reads;
  }

  void control_out(int, int, int) override { throw Error{Fault::protocol, name_ + ": has no vendor requests"}; }
  std::string control_in(int, int, int, int) override {
    throw Error{Fault::protocol, name_ + ": has no vendor requests"};
  }

  void write_report(const std::string& report) override {
    late_ = std::exchange(answer_, "");
    ++reports_;
    if (spoils("unplug")) throw Error{Fault::absent, name_ + ": is gone (LIBUSB_ERROR_NO_DEVICE)"};
    const auto at = [&](std::size_t i) { return i < report.size() ? static_cast<unsigned char>(report[i]) : 0; };
    const int command = at(5) << 8 | at(4);
    const int length = at(2) | at(3) << 8;
    const bool reading = (at(0) & 0x80) != 0;
    bool done = registers_.contains(command) && command != settings_.refuse && length >= 2 && !spoils("error");
    if (done && !reading) done = write(command, report.substr(6, length - 2));
    if ((at(0) & 0x40) == 0) return;
    const std::string data = done && reading ? read(command) : "";
    answer_ += static_cast<char>((reading ? 0x80 : 0) | (done ? 0 : 0x20));
    answer_ += static_cast<char>(at(1));
    answer_ += static_cast<char>(data.size());
    answer_ += '\0';
    answer_ += data;
    answer_.resize(64, '\0');
  }

  std::string read_report() override {
    if (spoils("unplug")) throw Error{Fault::absent, name_ + ": is gone (LIBUSB_ERROR_NO_DEVICE)"};
    std::string answer = spoils("late") ? std::exchange(late_, "") : answer_;
    if (answer.empty() || spoils("silent")) throw Error{Fault::busy, name_ + ": sent no report (LIBUSB_ERROR_TIMEOUT)"};
    if (spoils("garbage")) return std::string(64, '\x5A');
    if (spoils("truncated")) return answer.substr(0, 3);
    if (spoils("wrong-sender")) answer[1] = static_cast<char>(answer[1] + 100);
    return answer;
  }

  const std::string& name() const override { return name_; }
  Json about() const override {
    return {{"usb_id", settings_.dlpc900 ? "0451:c900" : "0451:6401"},
            {"serial", settings_.dlpc900 ? "LCR6500" : "LCR4500"},
            {"maker", "Texas Instruments (simulated)"},
            {"model", settings_.dlpc900 ? "DLPC900" : "DLPC350"}};
  }

 private:
  [[nodiscard]] bool spoils(const char* fault) const {
    return settings_.fault == fault && reports_ > settings_.fault_after;
  }
  [[nodiscard]] int value(int command) const { return static_cast<unsigned char>(registers_.at(command).at(0)); }

  // A DLPC900 has an image when it looks at its port and the receiver there is on.
  [[nodiscard]] bool image() const {
    return settings_.dlpc900 && !settings_.no_signal && (value(0x1A00) & 7) == 0 && value(0x1A01) != 0;
  }
  // Whether grey levels 0..255 are equal steps of light: by the engine's own state, not by what its user set.
  [[nodiscard]] bool linear() const {
    if (!settings_.dlpc900) return value(0x1A1B) == 0 && value(0x1A0E) < 0x80;
    return value(0x1A1B) == 2 && value(0x1A24) == 2 && all_bits_ == 0xFFFFFF;
  }

  // What flows through red, green and blue when they are enabled. The controller puts out a pulse of this width, of
  // either polarity; the drivers of a LightCrafter 4500 are on where it is off.
  [[nodiscard]] Json currents_percent() const {
    Json percent = Json::array();
    for (const char led : registers_.at(0x0B01)) {
      double pulse = static_cast<unsigned char>(led) / 255.0;
      if (value(0x1A05) != 0) pulse = 1 - pulse;
      percent.push_back(std::round(1000 * (settings_.dlpc900 ? pulse : 1 - pulse)) / 10);
    }
    return percent;
  }

  // The state it reports first is still the old one.
  std::string read(int command) {
    const bool slow = slow_[command] > 0 && slow_[command]-- > 0;
    if (slow && command == 0x0200) return std::string(1, '\1');
    if (slow && command == 0x1A1B && settings_.dlpc900) return std::string(1, '\0');
    if (command == 0x1A0C && settings_.dlpc900) {
      return std::string(1, static_cast<char>((value(0x1A24) == 2 ? 0x02 : 0) | (image() && !slow ? 0x18 : 0)));
    }
    return registers_[command];
  }

  // False: refused.
  bool write(int command, const std::string& data) {
    const int first = data.empty() ? 0 : static_cast<unsigned char>(data[0]);
    if (settings_.stuck_polarity && command == 0x1A05) return true;
    if (settings_.stuck_grey && (command == 0x1A0E || (command == 0x1A1B && first == 2))) return true;
    if (command == 0x1A1B && first == 2 && (!image() || value(0x1A1B) != 0)) return false;
    if (command == 0x1A24 && first == 2 && value(0x1A1B) != 2) return false;
    if (data.size() != registers_[command].size()) return false;
    const std::string before = std::exchange(registers_[command], data);
    if (command == 0x1A34) take_pattern(data);
    if (before == data || !log_) return true;
    const double now_s = device::real_clock().now_s();
    if (command == 0x0200 && first == 1) log_({{"t_monotonic_s", now_s}, {"event", "asleep"}});
    if (command != 0x1A07) return true;
    log_({{"t_monotonic_s", now_s},
          {"event", "leds"},
          {"bits", first},
          {"linear", linear()},
          {"current_percent", currents_percent()}});
    return true;
  }

  // The bits of a frame's pixel that patterns of 8 bits show, all of them for the same time.
  void take_pattern(const std::string& data) {
    const auto at = [&](std::size_t i) { return static_cast<unsigned char>(data[i]); };
    const int exposure_us = at(2) | at(3) << 8 | at(4) << 16;
    if (at(0) == 0) all_bits_ = 0;
    if ((at(5) >> 1 & 7) == 7 && 3 * exposure_us + 105 <= 16666) all_bits_ |= 0xFF << (at(11) >> 3);
  }

  SimDlpSettings settings_;
  SimLog log_;
  std::map<int, std::string> registers_;
  std::map<int, int> slow_;
  int all_bits_ = 0;
  std::string answer_, late_;
  int reports_ = 0;
  std::string name_;
};

}  // namespace

std::unique_ptr<device::UsbLink> make_sim_dlp(const SimDlpSettings& settings, SimLog log) {
  return std::make_unique<SimDlp>(settings, std::move(log));
}

}  // namespace vam::sim
