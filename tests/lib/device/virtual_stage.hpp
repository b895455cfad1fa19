// SPDX-License-Identifier: GPL-3.0-or-later
// A GCS stage in virtual time, with the simulator's truth in the test's hands.
#pragma once

#include <memory>
#include <vector>

#include "device/stage/stage_backends.hpp"
#include "sim/controllers/controllers.hpp"

namespace vam::device {

class SharedDevice final : public sim::SimDevice {
 public:
  explicit SharedDevice(std::shared_ptr<sim::SimDevice> device) : device_(std::move(device)) {}
  void opened(double now_s) override { device_->opened(now_s); }
  void receive(std::string_view bytes, double now_s) override { device_->receive(bytes, now_s); }
  void advance(double now_s) override { device_->advance(now_s); }
  std::optional<double> next_due_s() const override { return device_->next_due_s(); }
  std::string take(double now_s) override { return device_->take(now_s); }
  bool unplugged() const override { return device_->unplugged(); }

 private:
  std::shared_ptr<sim::SimDevice> device_;
};

/// A simulated controller, its log, and the stage that is opened on it.
struct StageLab {
  using MakeSim = std::unique_ptr<sim::SimDevice> (*)(const sim::SimGcsSettings&, double, sim::SimLog);
  StageLab(MakeSim make, const sim::SimGcsSettings& sim)
      : device(make(sim, clock.now_s(), [this](const Json& line) { log.push_back(line); })) {}
  StageLab(const StageLab&) = delete;
  StageLab& operator=(const StageLab&) = delete;

  [[nodiscard]] std::unique_ptr<Port> port() {
    return sim::make_sim_port(std::make_unique<SharedDevice>(device), clock);
  }
  /// The last of "moving" and "standing" in the simulator's own log.
  [[nodiscard]] bool truly_moves() {
    device->advance(clock.now_s());
    bool moves = false;
    for (const auto& line : log) {
      if (line["event"] == "moving") moves = true;
      if (line["event"] == "standing") moves = false;
    }
    return moves;
  }
  [[nodiscard]] int commands(const std::string& mnemonic) const {
    int count = 0;
    for (const auto& line : log) {
      if (line["event"] == "command" && line["text"].get<std::string>().rfind(mnemonic, 0) == 0) ++count;
    }
    return count;
  }

  VirtualClock clock;
  std::vector<Json> log;
  std::shared_ptr<sim::SimDevice> device;
  std::unique_ptr<Stage> stage;
};

struct VirtualStage : StageLab {
  explicit VirtualStage(const sim::SimGcsSettings& sim = {}, const GcsSettings& gcs = {})
      : StageLab(sim::make_sim_gcs, sim) {
    stage = make_gcs_stage(port(), clock, gcs, "1", nullptr);
  }
};

}  // namespace vam::device
