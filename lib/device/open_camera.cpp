#include "base/error.hpp"
#include "device/camera.hpp"
#include "device/camera_backends.hpp"

namespace vam::device {

double CameraSettings::patience_s(double period_s) const {
  return timeout_s.value_or(1 + 3 * period_s + 1e-6 * exposure_us.value_or(0));
}

std::optional<std::string> another_size(const CameraMode& mode, int columns, int rows) {
  if (columns == mode.columns && rows == mode.rows) return std::nullopt;
  const auto size = [](int across, int down) { return std::to_string(across) + " x " + std::to_string(down); };
  return size(columns, rows) + " pixels instead of " + size(mode.columns, mode.rows);
}

bool in_real_pace(const Address& address, const std::string& fallback) {
  const std::string pace = address.word("pace", fallback);
  if (pace != "real" && pace != "virtual") {
    throw Error{Fault::usage, "device '" + address.text + "': pace=" + pace + " is neither real nor virtual"};
  }
  return pace == "real";
}

const std::vector<std::string>& camera_schemes() {
  static const std::vector<std::string> schemes{"sim", "aravis", "v4l2", "replay"};
  return schemes;
}

std::unique_ptr<Camera> open_camera(const std::string& device, const CameraSettings& settings, const CameraBench& bench,
                                    Clock& clock) {
  const Address address = parse_address(device, camera_schemes());
  if (address.scheme == "sim") return open_sim_camera(address, settings, bench, clock);
  if (address.scheme == "replay") return open_replay_camera(address, settings, bench, clock);
  std::unique_ptr<DeviceLock> lock;
  std::unique_ptr<Camera> camera;
  if (address.scheme == "v4l2") {
    lock = std::make_unique<DeviceLock>(address.place);
    camera = open_v4l2_camera(address, settings, kernel_v4l2(), clock);
  } else {
    lock = std::make_unique<DeviceLock>("aravis:" + address.place);
    camera = open_aravis_camera(address, settings, clock);
  }
  camera->hold(std::move(lock));
  return camera;
}

}  // namespace vam::device
