// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/safety/guardian_actions.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>
#include <xf86drmMode.h>

#include "base/text/json.hpp"
#include "device/port/usb_link.hpp"

namespace vam::device {

namespace {

constexpr int write_timeout_ms = 50;

int nibble(char digit) { return digit <= '9' ? digit - '0' : digit - 'a' + 10; }

// True when the bytes are on their way out of this process.
bool write_all(int handle, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    pollfd ready{handle, POLLOUT, 0};
    if (poll(&ready, 1, write_timeout_ms) <= 0 || (ready.revents & POLLOUT) == 0) return false;
    const ssize_t written = write(handle, bytes.data() + done, bytes.size() - done);
    if (written <= 0) return false;
    done += static_cast<std::size_t>(written);
  }
  return true;
}

// The last close of a serial port throws away what has not left yet, so wait for it, but not for ever: tcdrain() has no
// time-out and a peer may hold the line by flow control.
void drain(int handle) {
  for (int waited_ms = 0; waited_ms < write_timeout_ms; ++waited_ms) {
    int queued = 0;
    if (ioctl(handle, TIOCOUTQ, &queued) != 0 || queued == 0) return;
    usleep(1000);
  }
}

bool try_usb(const Json& action) {
  try {
    const std::string ids = action.at("usb_id");
    const UsbId id{
        std::stoi(ids.substr(0, 4), nullptr, 16), {std::stoi(ids.substr(5), nullptr, 16)}, action.at("serial")};
    const auto link = open_usb(id, action.at("interface").get<int>());
    for (const auto& request : action.value("control", Json::array())) {
      link->control_out(request.at(0), request.at(1), request.at(2));
    }
    for (const auto& report : action.value("reports", Json::array())) link->write_report(from_hex(report));
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

// The device is opened afresh. The dead tool's claim on it goes with the tool, which may take some milliseconds.
bool carry_out_usb(const Json& action) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    if (try_usb(action)) return true;
    usleep(10000);
  }
  return false;
}

// A flip of the dead tool may be under way: then the card is busy until its next vertical blank.
bool blacken(const Json& action, int card) {
  const auto crtc = action.value("crtc", 0U);
  const auto black = action.value("framebuffer", 0U);
  for (int attempt = 0; attempt < 50; ++attempt) {
    if (drmModePageFlip(card, crtc, black, 0, nullptr) == 0) return true;
    usleep(2000);
  }
  return false;
}

}  // namespace

std::string to_hex(const std::string& bytes) {
  static const char* digits = "0123456789abcdef";
  std::string hex;
  for (const char c : bytes) {
    const auto value = static_cast<unsigned char>(c);
    hex += digits[value >> 4U];
    hex += digits[value & 15U];
  }
  return hex;
}

std::string from_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += static_cast<char>(nibble(hex[i]) * 16 + nibble(hex[i + 1]));
  }
  return bytes;
}

bool carry_out(const Json& action, int handle) {
  const auto what = action.value("do", "");
  if (what == "write") {
    tcflush(handle, TCOFLUSH);  // half a command of the dead tool must not come first
    const bool sent = write_all(handle, from_hex(action.value("hex", "")));
    drain(handle);
    return sent;
  }
  if (what == "nothing") return true;  // the end of the tool is all that it takes
  if (what == "drm") return blacken(action, handle);
  if (what == "usb") return carry_out_usb(action);
  return false;
}

}  // namespace vam::device
