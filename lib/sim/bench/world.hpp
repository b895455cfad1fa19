// SPDX-License-Identifier: GPL-3.0-or-later
// What happens on the simulated bench, out of the logs that the other simulators and tools write meanwhile.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/log/log_lines.hpp"
#include "base/text/json_fwd.hpp"
#include "sim/bench/scene.hpp"

namespace vam::sim {

struct SimSources {
  double speed_deg_s = 0;         // of the stage when there is no log of its angles; 0 deg at the start
  std::string angles;             // log of vam-sim stage (or of sim: of vam-stage): the true angle
  std::string shown;              // log of vam-project: which frame was shown when; default: the first one throughout
  double latency_s = 0;           // of the projector, from a flip to its light
  std::vector<GreyImage> images;  // that glow in the resin, by frame index; none: the print alone is seen
  std::function<std::vector<GreyImage>(const Json& event)> draw;  // of the test pattern that `shown` names next
  /// Of the sinogram that `shown` names next, as many as there were; may be empty.
  std::function<std::vector<GreyImage>(const Json& event, int frames)> renew;
};

/// Times are on CLOCK_MONOTONIC, as in the logs.
class SimWorld {
 public:
  /// print: that the light cures, from the first flip on; that of the logs so far has cured it at once.
  SimWorld(SimSources sources, double start_s, SimPrint* print = nullptr);
  /// What an exposure sees: cut where the image changes, and so finely that the stage turns by half a degree at most
  /// in a part (but into no more than eight). Times must not fall by more than a second from call to call. Throws
  /// Fault::data where the projector shows frames of which there are no images.
  std::vector<SimMoment> during(double from_s, double to_s);
  /// A moment by what `during` has read of the logs; the light cures nothing meanwhile.
  [[nodiscard]] SimMoment moment(double t_s) const;

 private:
  struct TableSample {
    double t_s, angle_deg, speed_deg_s;
  };
  using Images = std::vector<GreyImage>;
  struct Shown {
    double t_s;
    int frame;
    double lit_before_s;                   // light there had been until then
    std::shared_ptr<const Images> images;  // that the frames are
  };
  /// A log that need not exist yet. Where a new file has taken its name, as when a run begins again in the same folder,
  /// the old one's last lines come first, then the new one's.
  struct Log {
    std::string path;
    std::optional<LogLines> lines = {};
    std::uint64_t file = 0;  // its number
    void each_new(const std::function<void(const Json& line)>& take);
  };
  void read_logs();
  void show(const Json& event);
  void cure(double until_s, std::chrono::milliseconds most);
  void forget();
  [[nodiscard]] double angle_deg(double t_s) const;

  SimSources sources_;
  double start_s_;
  SimPrint* print_;
  std::shared_ptr<const Images> images_;  // of the flips to come
  std::optional<double> cured_s_;         // all light until then has reached the resin
  Log angles_, shown_;
  std::deque<TableSample> stage_;
  std::deque<Shown> flips_;
};

}  // namespace vam::sim
