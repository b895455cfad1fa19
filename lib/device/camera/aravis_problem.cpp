// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/private/aravis_problem.hpp"

#include <arv.h>

namespace vam::device {

AravisProblem::~AravisProblem() { g_clear_error(&error_); }

AravisProblem::operator GError**() {
  g_clear_error(&error_);
  return &error_;
}

bool AravisProblem::timed_out() const {
  return there() && error_->domain == ARV_DEVICE_ERROR &&
         (error_->code == ARV_DEVICE_ERROR_TIMEOUT || error_->code == ARV_DEVICE_ERROR_NOT_CONNECTED ||
          error_->code == ARV_DEVICE_ERROR_TRANSFER_ERROR);
}

std::string AravisProblem::text() const { return there() ? error_->message : "no reason given"; }

}  // namespace vam::device
