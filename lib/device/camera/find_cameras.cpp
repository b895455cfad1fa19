// SPDX-License-Identifier: GPL-3.0-or-later
#include <arv.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>

#include "device/camera/camera_backends.hpp"
#include "device/camera/v4l2_driver.hpp"

namespace vam::device {

namespace {

// GLib's sockets, which find GigE cameras, make a process ignore SIGPIPE for good: a tool whose reader has gone (head)
// would fail with "Broken pipe" instead of ending quietly.

/// What SIGPIPE does is afterwards as it was before.
class KeptSigpipe {
 public:
  KeptSigpipe() { sigaction(SIGPIPE, nullptr, &before_); }
  ~KeptSigpipe() { sigaction(SIGPIPE, &before_, nullptr); }
  KeptSigpipe(const KeptSigpipe&) = delete;
  KeptSigpipe& operator=(const KeptSigpipe&) = delete;

 private:
  struct sigaction before_ {};
};

std::string text(const char* value) { return value != nullptr ? value : ""; }

void add_genicam(std::vector<DeviceListing>& found) {
  const KeptSigpipe kept;
  arv_update_device_list();
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
    const std::string protocol = text(arv_get_device_protocol(i));
    if (protocol != "USB3Vision" && protocol != "GigEVision") continue;
    const std::string place = text(protocol == "GigEVision" ? arv_get_device_address(i) : arv_get_device_id(i));
    const std::string about = text(arv_get_device_vendor(i)) + " " + text(arv_get_device_model(i)) + " " +
                              text(arv_get_device_serial_nbr(i)) + ", " + protocol;
    found.push_back({"camera", "aravis:" + place, about, lock_obstacle("aravis:" + place)});
  }
}

// A camera has several nodes; those that give no images are left out.
void add_v4l2(const std::string& path, std::vector<DeviceListing>& found) {
  const std::string obstacle = node_obstacle(path);
  if (!obstacle.empty()) return found.push_back({"camera", "v4l2:" + path, "", obstacle});
  const auto driver = kernel_v4l2();
  v4l2_capability about{};
  if (driver->open(path.c_str()) < 0 || driver->control(VIDIOC_QUERYCAP, &about) != 0) return;
  const auto can = (about.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? about.device_caps : about.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0) return;
  found.push_back({"camera", "v4l2:" + path, reinterpret_cast<const char*>(about.card), ""});
}

}  // namespace

std::vector<DeviceListing> find_cameras() {
  std::vector<DeviceListing> found;
  add_genicam(found);
  std::vector<std::string> nodes;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", none)) {
    if (entry.path().filename().string().starts_with("video")) nodes.push_back(entry.path());
  }
  std::sort(nodes.begin(), nodes.end());
  for (const auto& node : nodes) add_v4l2(node, found);
  return found;
}

}  // namespace vam::device
