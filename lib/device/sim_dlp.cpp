#include "device/sim_dlp.hpp"

#include <map>
#include <utility>

#include "base/error.hpp"
#include "device/clock.hpp"

namespace vam::device {

namespace {

class SimDlp final : public UsbLink {
 public:
  SimDlp(const SimDlpSettings& settings, SimLog log) : settings_(settings), log_(std::move(log)) {
    name_ = settings.dlpc900 ? "usb:0451:c900:LCR6500" : "usb:0451:6401:LCR4500";
    registers_[0x0200] = std::string(1, '\1');  // asleep
    registers_[0x0205] = std::string("\x01\x00\x00\x04", 4) + std::string(12, '\0');
    registers_[0x0B01] = std::string(3, static_cast<char>(settings.current));
    registers_[0x1A00] = std::string(1, '\x0A');
    registers_[0x1A07] = std::string(1, '\x08');  // LEDs by the sequencer
    registers_[0x1A0A] = std::string(1, '\x01');
    registers_[0x1A0B] = std::string(1, '\x01');
    registers_[0x1A0C] = std::string(1, '\x02');
    registers_[0x1A0E] = std::string(1, '\x80');  // gamma on
    registers_[0x1A1B] = std::string(1, '\x01');
    registers_[0x1A24] = std::string(1, '\x00');
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
    const bool known = registers_.contains(command) && command != settings_.refuse && length >= 2 && !spoils("error");
    if (known && !reading) write(command, report.substr(6, static_cast<std::size_t>(length - 2)));
    if ((at(0) & 0x40) == 0) return;
    const bool waking = command == 0x0200 && settings_.wake_reads > 0 && reading && settings_.wake_reads-- > 0;
    const std::string data = !known || !reading ? "" : waking ? std::string(1, '\1') : registers_[command];
    answer_ += static_cast<char>((reading ? 0x80 : 0) | (known ? 0 : 0x20));
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
            {"maker", "Texas Instruments"},
            {"model", settings_.dlpc900 ? "DLPC900" : "DLPC350"}};
  }

 private:
  [[nodiscard]] bool spoils(const char* fault) const {
    return settings_.fault == fault && reports_ > settings_.fault_after;
  }
  void write(int command, const std::string& data) {
    if (command == 0x1A0E && settings_.stuck_gamma) return;
    const std::string before = std::exchange(registers_[command], data);
    if (command == 0x1A07 && before != data && log_) {
      log_({{"t_monotonic_s", real_clock().now_s()},
            {"event", "leds"},
            {"bits", static_cast<unsigned char>(data.at(0))}});
    }
  }

  SimDlpSettings settings_;
  SimLog log_;
  std::map<int, std::string> registers_;
  std::string answer_, late_;
  int reports_ = 0;
  std::string name_;
};

}  // namespace

std::unique_ptr<UsbLink> make_sim_dlp(const SimDlpSettings& settings, SimLog log) {
  return std::make_unique<SimDlp>(settings, std::move(log));
}

}  // namespace vam::device
