// What decides how a GenICam camera makes grey levels of light.
#pragma once

#include <arv.h>

#include <string>

#include "device/camera/camera.hpp"

namespace vam::device {

// Collects Aravis's messages; one problem at a time.
class Problem {
 public:
  ~Problem() { g_clear_error(&error_); }
  Problem() = default;
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;
  operator GError**() {  // NOLINT: the calls of Aravis take it as their last argument
    g_clear_error(&error_);
    return &error_;
  }
  [[nodiscard]] bool there() const { return error_ != nullptr; }
  [[nodiscard]] bool timed_out() const {
    return there() && error_->domain == ARV_DEVICE_ERROR &&
           (error_->code == ARV_DEVICE_ERROR_TIMEOUT || error_->code == ARV_DEVICE_ERROR_NOT_CONNECTED ||
            error_->code == ARV_DEVICE_ERROR_TRANSFER_ERROR);
  }
  [[nodiscard]] std::string text() const { return there() ? error_->message : "no reason given"; }

 private:
  GError* error_ = nullptr;
};

/// Switches off every automatic that the camera has, then sets gamma, gain and black level, and reads all of them back
/// into the mode. Throws Fault::protocol for a value that does not read back, Fault::usage for one that the camera has
/// no setting for.
void set_levels(ArvCamera* camera, const std::string& name, const CameraSettings& settings, CameraMode& mode);

}  // namespace vam::device
