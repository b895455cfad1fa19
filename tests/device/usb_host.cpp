// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a program on a machine with a simulated USB device: libusb in it is the real one, umockdev stands for the kernel
// and the simulators of lib/device for the hardware. usage: umockdev-wrapper usb_host DEVICE LOG PROGRAM ARGS...
// DEVICE: tic:, dlpc350: or dlpc900:, the last two with what is wrong with them (lib/sim/controllers/dlp.hpp):
// dlpc900:?fault=silent. Exit status: the program's. The device lives on for 120 ms after the program, as its guardian
// is late after 100; ?outlives=MS for longer.
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <umockdev.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "device/os/address.hpp"
#include "device/safety/guardian_actions.hpp"
#include "sim/controllers/dlp.hpp"
#include "sim/controllers/tic.hpp"

namespace {

using vam::device::UsbLink;

constexpr std::uint8_t end_in = 0x80;

// By the open file they were asked through: what a killed process left behind goes with it, as in the kernel.
using Transfers = std::map<UMockdevIoctlClient*, std::deque<UMockdevIoctlData*>>;

struct Host {
  std::unique_ptr<UsbLink> link;
  Transfers done;        // and not yet fetched
  Transfers unanswered;  // until libusb's patience is over
  std::string descriptors;
  GMainLoop* loop = nullptr;
  int status = 70;
  int outlives_ms = 120;
};

int low_byte_first(const std::uint8_t* bytes) { return bytes[0] | bytes[1] << 8; }

// A string descriptor in UTF-16.
std::string string_descriptor(int index, const vam::Json& about) {
  if (index == 0) return std::string("\x04\x03\x09\x04", 4);
  const std::string text = about[index == 1 ? "maker" : index == 2 ? "model" : "serial"];
  std::string bytes{static_cast<char>(2 + 2 * text.size()), 3};
  for (const char c : text) bytes += std::string{c, '\0'};
  return bytes;
}

// Standard and vendor requests on endpoint 0. Returns the bytes moved, or a negative errno.
int control(Host& host, std::uint8_t* buffer) {
  const int type = buffer[0];
  const int request = buffer[1];
  const int value = low_byte_first(buffer + 2);
  const int index = low_byte_first(buffer + 4);
  const int length = low_byte_first(buffer + 6);
  std::string answer;
  if ((type & 0x60) == 0x40) {
    if ((type & end_in) == 0) {
      host.link->control_out(request, value, index);
      return 0;
    }
    answer = host.link->control_in(request, value, index, length);
  } else if (request == 6 && value >> 8 == 3) {
    answer = string_descriptor(value & 0xFF, host.link->about());
  } else {
    return (type & end_in) != 0 ? -EPIPE : 0;
  }
  answer.resize(std::min(answer.size(), static_cast<std::size_t>(length)));
  std::copy(answer.begin(), answer.end(), buffer + 8);
  return static_cast<int>(answer.size());
}

int interrupt(Host& host, const usbdevfs_urb& urb, std::uint8_t* buffer) {
  if ((urb.endpoint & end_in) == 0) {
    host.link->write_report(std::string(reinterpret_cast<char*>(buffer), static_cast<std::size_t>(urb.buffer_length)));
    return urb.buffer_length;
  }
  const std::string report = host.link->read_report();
  std::copy(report.begin(), report.end(), buffer);
  return static_cast<int>(report.size());
}

void finish(Host& host, UMockdevIoctlClient* client, UMockdevIoctlData* data, int moved) {
  auto* urb = reinterpret_cast<usbdevfs_urb*>(data->data);
  urb->status = std::min(moved, 0);
  urb->actual_length = std::max(moved, 0);
  host.done[client].push_back(data);
}

void submit(Host& host, UMockdevIoctlClient* client, UMockdevIoctlData* arg) {
  UMockdevIoctlData* data = umockdev_ioctl_data_resolve(arg, 0, sizeof(usbdevfs_urb), nullptr);
  if (data == nullptr) return umockdev_ioctl_client_abort(client);  // killed while it asked
  auto* urb = reinterpret_cast<usbdevfs_urb*>(data->data);
  UMockdevIoctlData* buffer = umockdev_ioctl_data_resolve(data, offsetof(usbdevfs_urb, buffer),
                                                          static_cast<gsize>(urb->buffer_length), nullptr);
  if (buffer == nullptr) return umockdev_ioctl_client_abort(client);
  try {
    finish(host, client, data,
           urb->type == USBDEVFS_URB_TYPE_CONTROL ? control(host, buffer->data) : interrupt(host, *urb, buffer->data));
  } catch (const vam::Error& error) {
    if (error.fault == vam::Fault::busy) {
      host.unanswered[client].push_back(data);
    } else {
      finish(host, client, data, error.fault == vam::Fault::absent ? -ENODEV : -EPIPE);
    }
  }
  umockdev_ioctl_client_complete(client, 0, 0);
}

void discard(Host& host, UMockdevIoctlClient* client, UMockdevIoctlData* arg) {
  gulong wanted = 0;
  std::memcpy(&wanted, arg->data, sizeof wanted);
  auto& waiting = host.unanswered[client];
  const auto found =
      std::find_if(waiting.begin(), waiting.end(), [&](auto* urb) { return urb->client_addr == wanted; });
  if (found == waiting.end()) return umockdev_ioctl_client_complete(client, -1, EINVAL);
  finish(host, client, *found, -ENOENT);
  waiting.erase(found);
  umockdev_ioctl_client_complete(client, 0, 0);
}

void reap(Host& host, UMockdevIoctlClient* client, UMockdevIoctlData* arg) {
  auto& done = host.done[client];
  if (done.empty()) return umockdev_ioctl_client_complete(client, -1, EAGAIN);
  UMockdevIoctlData* urb = done.front();
  done.pop_front();
  UMockdevIoctlData* pointer = umockdev_ioctl_data_resolve(arg, 0, sizeof(void*), nullptr);
  if (pointer == nullptr) return umockdev_ioctl_client_abort(client);
  umockdev_ioctl_data_set_ptr(pointer, 0, urb);
  umockdev_ioctl_client_complete(client, 0, 0);
}

// umockdev does not report clients that have gone, and may put a new one where an old one was.
void connected(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer user) {
  static_cast<Host*>(user)->done.erase(client);
  static_cast<Host*>(user)->unanswered.erase(client);
}

gboolean handle(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer user) {
  Host& host = *static_cast<Host*>(user);
  UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
  switch (umockdev_ioctl_client_get_request(client)) {
    case USBDEVFS_GET_CAPABILITIES: {
      UMockdevIoctlData* bits = umockdev_ioctl_data_resolve(arg, 0, sizeof(guint32), nullptr);
      const guint32 none = 0;
      std::memcpy(bits->data, &none, sizeof none);
      umockdev_ioctl_client_complete(client, 0, 0);
      return TRUE;
    }
    case USBDEVFS_SUBMITURB:
      submit(host, client, arg);
      return TRUE;
    case USBDEVFS_REAPURB:
    case USBDEVFS_REAPURBNDELAY:
      reap(host, client, arg);
      return TRUE;
    case USBDEVFS_GETDRIVER:
      umockdev_ioctl_client_complete(client, -1, ENODATA);
      return TRUE;
    case USBDEVFS_DISCARDURB:
      discard(host, client, arg);
      return TRUE;
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_RELEASEINTERFACE:
    case USBDEVFS_DISCONNECT_CLAIM:
    case USBDEVFS_IOCTL:
      umockdev_ioctl_client_complete(client, 0, 0);
      return TRUE;
    default:
      return FALSE;
  }
}

std::string bytes_of(std::initializer_list<int> values) {
  std::string bytes;
  for (const int value : values) bytes += static_cast<char>(value);
  return bytes;
}

// Device, configuration, one interface of class 3 (HID) or 255, two interrupt endpoints of 64 bytes.
std::string descriptors(const std::string& ids, int interface_class) {
  const int vendor = std::stoi(ids.substr(0, 4), nullptr, 16);
  const int product = std::stoi(ids.substr(5), nullptr, 16);
  return bytes_of(
             {18, 1, 0, 2, 0, 0, 0, 64, vendor & 255, vendor >> 8, product & 255, product >> 8, 0, 1, 1, 2, 3, 1}) +
         bytes_of({9, 2, 32, 0, 1, 1, 0, 0x80, 50}) + bytes_of({9, 4, 0, 0, 2, interface_class, 0, 0, 0}) +
         bytes_of({7, 5, 0x81, 3, 64, 0, 1}) + bytes_of({7, 5, 0x01, 3, 64, 0, 1});
}

std::unique_ptr<UsbLink> simulate(const vam::device::Address& address, const vam::sim::SimLog& log) {
  if (address.scheme == "tic") {
    vam::sim::SimTicSettings tic;
    tic.referenced = address.word("referenced", "") == "yes";
    return vam::sim::make_sim_tic(tic, vam::device::real_clock(), log);
  }
  vam::sim::SimDlpSettings settings;
  settings.dlpc900 = address.scheme == "dlpc900";
  settings.current_percent = address.number("current_percent", settings.current_percent, 0, 100);
  settings.inverted = address.word("inverted", "") == "yes";
  settings.stuck_grey = address.word("stuck_grey", "") == "yes";
  settings.slow_reads = address.integer("slow_reads", 0, 1000).value_or(0);
  settings.fault = address.word("fault", "");
  settings.fault_after = address.integer("fault_after", 0, 1000).value_or(0);
  return vam::sim::make_sim_dlp(settings, log);
}

void ended(GPid, gint status, gpointer user) {
  Host& host = *static_cast<Host*>(user);
  host.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  g_timeout_add(
      static_cast<guint>(host.outlives_ms),
      [](gpointer loop) {
        g_main_loop_quit(static_cast<GMainLoop*>(loop));
        return FALSE;
      },
      host.loop);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 64;
  const auto address = vam::device::parse_address(argv[1], {"tic", "dlpc350", "dlpc900"});
  address.allow(
      {"current_percent", "inverted", "referenced", "stuck_grey", "slow_reads", "fault", "fault_after", "outlives"});
  Host host;
  host.outlives_ms = address.integer("outlives", 0, 10000).value_or(host.outlives_ms);
  host.link = simulate(address, vam::sim::file_sim_log(argv[2]));
  const std::string ids = host.link->about()["usb_id"];
  host.descriptors = descriptors(ids, address.scheme == "tic" ? 255 : 3);

  UMockdevTestbed* testbed = umockdev_testbed_new();
  const std::string tree =
      "P: /devices/usb1/1-1\nN: bus/usb/001/002\nE: DEVNAME=/dev/bus/usb/001/002\nE: DEVTYPE=usb_device\n"
      "E: SUBSYSTEM=usb\nE: BUSNUM=001\nE: DEVNUM=002\nE: MAJOR=189\nE: MINOR=1\nA: busnum=1\\n\n"
      "A: devnum=2\\n\nA: speed=12\\n\nA: bConfigurationValue=1\\n\nA: idVendor=" +
      ids.substr(0, 4) + "\\n\nA: idProduct=" + ids.substr(5) +
      "\\n\nH: descriptors=" + vam::device::to_hex(host.descriptors) +
      "\n\nP: /devices/virtual/tty/tty\nE: SUBSYSTEM=tty\n";  // for which the shim takes every pseudo-terminal
  GError* problem = nullptr;
  if (umockdev_testbed_add_from_string(testbed, tree.c_str(), &problem) == FALSE) {
    std::fprintf(stderr, "usb_host: %s\n", problem->message);
    return 70;
  }
  UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
  g_signal_connect(handler, "handle-ioctl", G_CALLBACK(handle), &host);
  g_signal_connect(handler, "client-connected", G_CALLBACK(connected), &host);
  if (umockdev_testbed_attach_ioctl(testbed, "/dev/bus/usb/001/002", handler, &problem) == FALSE) {
    std::fprintf(stderr, "usb_host: %s\n", problem->message);
    return 70;
  }
  host.loop = g_main_loop_new(nullptr, FALSE);
  GPid child = 0;
  const auto flags =
      static_cast<GSpawnFlags>(G_SPAWN_SEARCH_PATH | G_SPAWN_DO_NOT_REAP_CHILD | G_SPAWN_CHILD_INHERITS_STDIN);
  if (g_spawn_async(nullptr, argv + 3, nullptr, flags, nullptr, nullptr, &child, &problem) == FALSE) {
    std::fprintf(stderr, "usb_host: %s\n", problem->message);
    return 70;
  }
  g_child_watch_add(child, ended, &host);
  g_main_loop_run(host.loop);
  g_object_unref(testbed);
  return host.status;
}
