// SPDX-License-Identifier: GPL-3.0-or-later
// The guardian's order to stop a stage: in force from the first motion command until the stage is known to be at rest.
#pragma once

#include <optional>
#include <string>

#include "base/text/json_fwd.hpp"
#include "device/safety/guardian.hpp"

namespace vam::device {

class StopOrder {
 public:
  /// Without a guardian the order is only remembered.
  explicit StopOrder(Guardian* guardian) : guardian_(guardian) {}

  /// Before the command that sets the stage moving: bytes that stop it, to be written to its port. A simulated port
  /// has no handle (-1) and ends with the tool; then the order is only remembered.
  void give(const std::string& bytes, int handle);
  /// The same by any action of guardian_actions.hpp.
  void give(const Json& action, int handle = -1);
  /// The stage stands.
  void withdraw() {
    standing_ = false;
    if (action_) guardian_->forget(*action_);
    action_.reset();
  }
  [[nodiscard]] bool standing() const { return standing_; }
  /// The controller has answered.
  void beat() {
    if (guardian_ != nullptr) guardian_->beat();
  }

 private:
  Guardian* guardian_;
  bool standing_ = false;
  std::optional<int> action_;
};

}  // namespace vam::device
