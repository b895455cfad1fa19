// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/cameras/camera.hpp"

#include "device/camera/camera_backends.hpp"
#include "device/open/open.hpp"
#include "device/open/private/backends.hpp"
#include "model/device_schemes.hpp"

namespace vam::device {

namespace {

std::unique_ptr<Camera> locked(std::unique_ptr<DeviceLock> lock, std::unique_ptr<Camera> camera) {
  camera->hold(std::move(lock));
  return camera;
}

std::unique_ptr<Camera> open_v4l2(const Address& address, const CameraSettings& settings, const CameraBench&,
                                  Clock& clock) {
  auto lock = std::make_unique<DeviceLock>(address.place);
  return locked(std::move(lock), open_v4l2_camera(address, settings, kernel_v4l2(), clock));
}

std::unique_ptr<Camera> open_aravis(const Address& address, const CameraSettings& settings, const CameraBench&,
                                    Clock& clock) {
  auto lock = std::make_unique<DeviceLock>("aravis:" + address.place);
  return locked(std::move(lock), open_aravis_camera(address, settings, clock));
}

struct CameraBackend {
  const char* scheme;
  std::unique_ptr<Camera> (*open)(const Address& address, const CameraSettings& settings, const CameraBench& bench,
                                  Clock& clock);
};

constexpr CameraBackend backends[] = {
    {"aravis", open_aravis}, {"v4l2", open_v4l2}, {"replay", open_replay_camera}, {"sim", sim::open_sim_camera}};
static_assert(model::has_schemes(backends, model::camera_schemes));

}  // namespace

std::unique_ptr<Camera> open_camera(const std::string& device, const CameraSettings& settings, const CameraBench& bench,
                                    Clock& clock) {
  require_named(device, "camera", "aravis:192.168.1.7");
  const Address address = parse_device(device, model::camera_schemes);
  return backend_of(backends, address).open(address, settings, bench, clock);
}

}  // namespace vam::device
