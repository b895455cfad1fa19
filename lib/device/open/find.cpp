// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/open/find.hpp"

#include <iterator>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "device/camera/camera_backends.hpp"
#include "device/open/open.hpp"
#include "device/os/clock.hpp"
#include "device/port/find_ports.hpp"
#include "device/projector/display_backends.hpp"
#include "model/device_schemes.hpp"

namespace vam::device {

namespace {

std::string in_words(const Json& identity) {
  std::string words;
  for (const char* key : {"maker", "model", "serial"}) {
    const auto found = identity.find(key);
    if (found == identity.end() || !found->is_string() || found->get<std::string>().empty()) continue;
    words += (words.empty() ? "" : " ") + found->get<std::string>();
  }
  return words;
}

}  // namespace

std::vector<DeviceListing> find_devices(const std::vector<std::string>& ports) {
  std::vector<DeviceListing> all = find_serial_stages(ports);
  for (auto& some : {find_usb_devices(), find_cameras(), find_displays()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

void ask_stage(DeviceListing& stage) {
  const std::string path = stage.device.substr(stage.device.find(':') + 1);
  if (!path.starts_with('/') || !stage.obstacle.empty()) return;
  for (const auto& known : model::stage_schemes) {
    if (known.place != "PATH") continue;
    const std::string device = std::string(known.scheme) + ":" + path;
    try {
      stage.about = in_words(open_stage(device, real_clock(), nullptr)->identify());
      stage.device = device;
      return;
    } catch (const Error& error) {
      if (error.fault == Fault::absent) {
        stage.obstacle = error.what();
        return;
      }
    }
  }
  stage.obstacle = "no reply from a stage; check power and cable, and for gcs: in a daisy chain ?address=N";
}

}  // namespace vam::device
