// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/projector/private/dlp_link.hpp"

#include <array>
#include <cstdio>

#include "device/safety/guardian_actions.hpp"

namespace vam::device {

namespace {

constexpr int read_request = 0xC0;
constexpr int not_acknowledged = 0x20;
constexpr std::size_t header_bytes = 4;
constexpr double between_polls_s = 0.02;

std::string text_of(const DlpBytes& bytes) {
  std::string text;
  for (const int byte : bytes) text += static_cast<char>(byte);
  return text;
}

}  // namespace

std::string dlp_report(int flags, int sequence, DlpCommand command, const DlpBytes& data) {
  const auto number = static_cast<int>(command);
  return text_of({flags, sequence, static_cast<int>(2 + data.size()), 0, number & 0xFF, number >> 8}) + text_of(data);
}

DlpBytes DlpLink::exchange(int flags, DlpCommand command, const DlpBytes& data) {
  sequence_ = (sequence_ + 1) & 0xFF;
  usb_->write_report(dlp_report(flags, sequence_, command, data));
  // An answer to an older question may still be under way; its sequence number tells.
  for (int attempt = 0; attempt < 4; ++attempt) {
    const std::string report = usb_->read_report();
    const std::vector<unsigned char> answer(report.begin(), report.end());
    if (answer.size() < header_bytes) break;
    if (answer[1] != sequence_) continue;
    if ((answer[0] & not_acknowledged) != 0) throw wrong(command, "refused");
    const auto length = answer[2] + std::size_t{256} * answer[3];
    if (header_bytes + length > answer.size()) {
      throw wrong(command, "answered with a length of " + std::to_string(length));
    }
    if (guardian_ != nullptr) guardian_->beat();
    const auto first = answer.begin() + header_bytes;
    return {first, first + static_cast<std::ptrdiff_t>(length)};
  }
  throw wrong(command, "answered with another command");
}

Error DlpLink::wrong(DlpCommand command, const std::string& what) const {
  const auto number = static_cast<unsigned>(command);
  std::array<char, 24> shown{};
  std::snprintf(shown.data(), shown.size(), "command %02X %02X", number >> 8U, number & 0xFFU);
  return {Fault::protocol, name() + ": " + shown.data() + " was " + what};
}

DlpBytes DlpLink::ask(DlpCommand command, std::size_t bytes) {
  DlpBytes data = exchange(read_request, command, {});
  if (data.size() < bytes) throw wrong(command, "answered with " + std::to_string(data.size()) + " bytes");
  data.resize(bytes);
  return data;
}

void DlpLink::set(DlpCommand command, const DlpBytes& data, const std::string& what, double patience_s) {
  tell(command, data);
  DlpBytes back;
  if (within(patience_s, [&] { return (back = ask(command, data.size())) == data; })) return;
  throw Error{Fault::protocol, name() + ": " + what + " was set to " + to_hex(text_of(data)) + " but reads back as " +
                                   to_hex(text_of(back))};
}

bool DlpLink::within(double patience_s, const std::function<bool()>& done) {
  const double limit_s = clock_.now_s() + patience_s;
  while (!done()) {
    if (clock_.now_s() >= limit_s) return false;
    clock_.sleep_until(clock_.now_s() + between_polls_s);
  }
  return true;
}

}  // namespace vam::device
