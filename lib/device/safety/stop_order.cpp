// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/safety/stop_order.hpp"

#include "base/text/json.hpp"
#include "device/safety/guardian_actions.hpp"

namespace vam::device {

void StopOrder::give(const std::string& bytes, int handle) {
  if (handle < 0) {
    standing_ = true;
  } else {
    give({{"do", "write"}, {"order", 1}, {"name", "stage"}, {"hex", to_hex(bytes)}}, handle);
  }
}

void StopOrder::give(const Json& action, int handle) {
  standing_ = true;
  if (guardian_ != nullptr && !action_) action_ = guardian_->add(action, handle);
}

}  // namespace vam::device
