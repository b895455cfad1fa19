// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/port/serial_port.hpp"

#include <libserialport.h>
#include <poll.h>
#include <sys/ioctl.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "device/os/clock.hpp"
#include "device/os/interrupt.hpp"
#include "device/port/usb_kinds.hpp"

namespace vam::device {

namespace {

constexpr double write_timeout_s = 0.5;

struct PortCloser {
  void operator()(sp_port* port) const {
    sp_close(port);
    sp_free_port(port);
  }
};
using PortHandle = std::unique_ptr<sp_port, PortCloser>;

std::string last_message() {
  char* text = sp_last_error_message();
  std::string message = text != nullptr ? text : "no reason given";
  sp_free_error_message(text);
  return message;
}

Error refused(const std::string& path, sp_return status, const std::string& doing) {
  if (path.empty()) return {Fault::usage, "device: names no serial port; write for example gcs:/dev/ttyUSB0"};
  if (status == SP_ERR_ARG)
    return {Fault::absent, path + ": not a serial port of this machine (vam-stage ports lists them)"};
  return {Fault::absent, path + ": cannot " + doing + " (" + last_message() + ")"};
}

// An FTDI chip holds answers back for 16 ms by default, 0.4 degrees at 25 deg/s; 1 ms needs a write to sysfs.
void shorten_latency(const std::string& path) {
  const auto file = "/sys/class/tty/" + std::filesystem::path(path).filename().string() + "/device/latency_timer";
  int latency_ms = 0;
  if (!(std::ifstream(file) >> latency_ms) || latency_ms <= 1) return;
  std::ofstream(file) << 1;
  std::ifstream(file) >> latency_ms;
  if (latency_ms > 1) {
    warn(path + ": its latency timer is " + std::to_string(latency_ms) +
         " ms, which adds to the angle error; write 1 to " + file);
  }
}

class SerialPort final : public Port {
 public:
  SerialPort(std::string path, PortHandle port, int handle)
      : path_(std::move(path)), port_(std::move(port)), handle_(handle) {}

  void write(std::string_view bytes) override {
    const double deadline_s = real_clock().now_s() + write_timeout_s;
    while (!bytes.empty()) {
      if (!wait(POLLOUT, deadline_s)) {
        throw Error{Fault::busy,
                    path_ + ": does not accept data (" + std::to_string(bytes.size()) + " left after 0.5 s)"};
      }
      const int written = sp_nonblocking_write(port_.get(), bytes.data(), bytes.size());
      if (written < 0) throw unplugged();
      bytes.remove_prefix(written);
    }
  }

  std::string read(double timeout_s) override {
    if (!wait(POLLIN, real_clock().now_s() + timeout_s)) return "";
    std::array<char, 4096> bytes{};
    const int count = sp_nonblocking_read(port_.get(), bytes.data(), bytes.size());
    if (count <= 0) throw unplugged();  // readable, yet nothing to read: the line is gone
    return {bytes.data(), static_cast<std::size_t>(count)};
  }

  const std::string& name() const override { return path_; }
  int handle() const override { return handle_; }

 private:
  // libserialport's own waits take a time-out of 0 for "for ever" and report an unplugged port as a time-out at full
  // processor load; poll() on the descriptor tells all three apart.
  bool wait(short what, double deadline_s) {
    for (;;) {
      check_interrupted();
      const double left_s = deadline_s - real_clock().now_s();
      std::array<pollfd, 2> watched{pollfd{handle_, what, 0}, pollfd{interrupt_fd(), POLLIN, 0}};
      const int left_ms = left_s > 0 ? ceil_int(left_s * 1000) : 0;
      poll(watched.data(), watched.size(), left_ms);
      if ((watched[0].revents & what) != 0) return true;
      if ((watched[0].revents & (POLLHUP | POLLERR | POLLNVAL)) != 0) throw unplugged();
      if (left_s <= 0) return false;
    }
  }

  [[nodiscard]] Error unplugged() const {
    return {Fault::absent, path_ + ": unplugged; the device finishes its last motion command"};
  }

  std::string path_;
  PortHandle port_;
  int handle_;
};

}  // namespace

std::unique_ptr<Port> open_serial(const std::string& path, int baud) {
  std::error_code none;
  const auto real = std::filesystem::canonical(path, none);  // /dev/serial/by-id/... is a link
  sp_port* found = nullptr;
  sp_return status = sp_get_port_by_name(real.c_str(), &found);
  if (status != SP_OK) throw refused(path, status, "be found");
  PortHandle port(found);
  status = sp_open(port.get(), SP_MODE_READ_WRITE);
  if (status == SP_ERR_FAIL && sp_last_error_code() == EBUSY) {
    throw Error{Fault::busy, path + ": opened by another program; end that program first"};
  }
  if (status != SP_OK) throw refused(path, status, "be opened");
  int handle = -1;
  sp_get_port_handle(port.get(), &handle);
  ioctl(handle, TIOCEXCL);
  if (sp_set_baudrate(port.get(), baud) != SP_OK || sp_set_bits(port.get(), 8) != SP_OK ||
      sp_set_parity(port.get(), SP_PARITY_NONE) != SP_OK || sp_set_stopbits(port.get(), 1) != SP_OK ||
      sp_set_flowcontrol(port.get(), SP_FLOWCONTROL_NONE) != SP_OK) {
    throw Error{Fault::absent,
                path + ": cannot be set to " + std::to_string(baud) + " baud 8N1 (" + last_message() + ")"};
  }
  sp_flush(port.get(), SP_BUF_BOTH);
  shorten_latency(real);
  return std::make_unique<SerialPort>(path, std::move(port), handle);
}

Json list_serial_ports() {
  Json ports = Json::array();
  sp_port** list = nullptr;
  if (sp_list_ports(&list) != SP_OK) return ports;
  const auto text = [](const char* value) { return value != nullptr ? Json(value) : Json(nullptr); };
  for (sp_port** port = list; *port != nullptr; ++port) {
    Json entry{{"path", sp_get_port_name(*port)}, {"description", text(sp_get_port_description(*port))}};
    int vendor = 0;
    int product = 0;
    if (sp_get_port_usb_vid_pid(*port, &vendor, &product) == SP_OK) {
      entry["usb_id"] = ids_text(vendor, product);
      entry["manufacturer"] = text(sp_get_port_usb_manufacturer(*port));
      entry["product"] = text(sp_get_port_usb_product(*port));
      entry["serial"] = text(sp_get_port_usb_serial(*port));
    }
    ports.push_back(entry);
  }
  sp_free_port_list(list);
  return ports;
}

}  // namespace vam::device
