// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated GigE Vision camera on a network address of this machine, by Aravis' fake camera. A real GenICam client
// opens it by its IP address.
#pragma once

#include <memory>
#include <string>

#include "sim/cameras/camera.hpp"

namespace vam::sim {

/// Serves from the constructor to the destructor, in a thread of its own. The bench's columns and rows are the sensor;
/// region, binning, exposure, frame rate and pixel format (Mono8, Mono16) are the client's. Frames count from the first
/// one sent. A time stamp is the start, middle or end of the exposure plus lag_s, by the camera's own clock
/// (private/gv_clock.hpp).
class SimGvCamera {
 public:
  /// Throws Fault::busy when the address has a camera already, Fault::usage when it is none of this machine.
  SimGvCamera(const SimCameraSettings& settings, const std::string& address, const std::string& serial, SimLog log);
  ~SimGvCamera();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::sim
