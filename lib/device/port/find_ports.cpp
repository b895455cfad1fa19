// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/port/find_ports.hpp"

#include <libusb.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "device/port/serial_port.hpp"
#include "device/port/usb_kinds.hpp"

namespace vam::device {

namespace {

// Which protocol the maker of a USB serial port points to.
struct Vendor {
  std::string_view id;
  const char* scheme;
};
constexpr std::array vendors{Vendor{"1a72", "gcs"}, Vendor{"2341", "grbl"}, Vendor{"2a03", "grbl"},
                             Vendor{"1a86", "grbl"}};

DeviceListing serial_stage(const Json& entry) {
  const std::string path = text_at(entry, "path");
  const std::string ids = text_at(entry, "usb_id");
  const auto* maker =
      std::find_if(vendors.begin(), vendors.end(), [&](const Vendor& vendor) { return ids.starts_with(vendor.id); });
  DeviceListing found{"stage", "gcs:" + path, text_at(entry, "description"), node_obstacle(path)};
  if (maker != vendors.end()) found.device = maker->scheme + (":" + path);
  for (const char* key : {"manufacturer", "serial"}) {
    if (const std::string more = text_at(entry, key); !more.empty())
      found.about += (found.about.empty() ? "" : " ") + more;
  }
  return found;
}

// USB3 Vision: an interface of class 0xEF, subclass 5 (USB3 Vision Specification, table 4-1).
bool is_vision(libusb_device* device) {
  libusb_config_descriptor* config = nullptr;
  if (libusb_get_active_config_descriptor(device, &config) != 0) return false;
  bool vision = false;
  for (int i = 0; i < config->bNumInterfaces; ++i) {
    const libusb_interface& interface = config->interface[i];
    for (int a = 0; a < interface.num_altsetting; ++a) {
      vision |= interface.altsetting[a].bInterfaceClass == 0xEF && interface.altsetting[a].bInterfaceSubClass == 5;
    }
  }
  libusb_free_config_descriptor(config);
  return vision;
}

std::string usb_obstacle(int status, int vendor) {
  if (status == LIBUSB_ERROR_NO_DEVICE) return "is being unplugged";
  return "not permitted to this user; write SUBSYSTEM==\"usb\", ATTR{idVendor}==\"" + ids_text(vendor, 0).substr(0, 4) +
         "\", TAG+=\"uaccess\" to /etc/udev/rules.d/70-vam.rules and plug it in again";
}

void look_at(libusb_device* device, std::vector<DeviceListing>& found) {
  libusb_device_descriptor about{};
  if (libusb_get_device_descriptor(device, &about) != 0) return;
  const UsbKind* kind = usb_kind(about.idVendor, about.idProduct);
  if (kind == nullptr && !is_vision(device)) return;
  const std::string ids = ids_text(about.idVendor, about.idProduct);
  libusb_device_handle* handle = nullptr;
  const int status = libusb_open(device, &handle);
  if (kind == nullptr) {  // one that can be opened is listed with the cameras
    if (status != 0) found.push_back({"camera", "aravis:", "USB3 Vision " + ids, usb_obstacle(status, about.idVendor)});
  } else if (status != 0) {
    found.push_back({kind->kind, std::string(kind->scheme) + ":" + kind->options, "USB " + ids,
                     usb_obstacle(status, about.idVendor)});
  } else {
    const std::string serial = string_of(handle, about.iSerialNumber);
    found.push_back({kind->kind, std::string(kind->scheme) + ":" + serial + kind->options,
                     string_of(handle, about.iManufacturer) + " " + string_of(handle, about.iProduct),
                     lock_obstacle("usb:" + ids + ":" + serial)});
  }
  if (handle != nullptr) libusb_close(handle);
}

// Of a port that the user names.
std::string named_obstacle(const std::string& path) {
  std::string obstacle = node_obstacle(path);
  struct stat about {};
  if (!obstacle.empty() || stat(path.c_str(), &about) != 0) return obstacle;
  constexpr unsigned memory_devices = 1;  // null, zero, random
  return S_ISCHR(about.st_mode) && major(about.st_rdev) != memory_devices ? "" : "is not a serial port";
}

}  // namespace

std::vector<DeviceListing> find_serial_stages(const std::vector<std::string>& ports) {
  std::vector<DeviceListing> found;
  for (const Json& entry : list_serial_ports()) found.push_back(serial_stage(entry));
  for (const std::string& path : ports) found.push_back({"stage", "gcs:" + path, "", named_obstacle(path)});
  return found;
}

std::vector<DeviceListing> find_usb_devices() {
  std::vector<DeviceListing> found;
  libusb_context* context = nullptr;
  if (libusb_init(&context) != 0) return found;
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  for (ssize_t i = 0; i < count; ++i) look_at(list[i], found);
  if (count >= 0) libusb_free_device_list(list, 1);
  libusb_exit(context);
  return found;
}

}  // namespace vam::device
