// SPDX-License-Identifier: GPL-3.0-or-later
// Stage, projector and camera of all scans, driven by their tools.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/log/log_lines.hpp"
#include "base/text/json_fwd.hpp"
#include "cli/common.hpp"
#include "device/os/child.hpp"
#include "device/os/event_log.hpp"
#include "model/printer.hpp"

namespace vam::calibrate_tool {

/// What vam-calibrate all is asked for.
struct AllOptions {
  std::string display, light;
  cli::PrinterOptions printer;
  std::string scans = "lag,latency,response,axis,edges";
  bool accept = false, home = false;
  std::optional<int> pitch_px;
  std::optional<double> sweep_exposure_us;
  std::string keep, log;
};

/// A tool has failed; what it said is the reason.
struct Failed {
  int status;
  std::string said;
};

using Words = std::vector<std::string>;

/// Whatever ends it, the light goes off and the stage stands. What drives devices throws Failed, device::Interrupted.
class Bench {
 public:
  /// Throws Error: no_output (the log, the folder), and as io::load_printer does.
  explicit Bench(const AllOptions& options);
  ~Bench() { end(); }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  /// Asks every device, before anything moves or is lit.
  void identify();
  /// Whose frames, records and events are next; shown on a terminal with `place`.
  void begin(const std::string& scan, const std::string& place);

  void note(const std::string& event, Json facts);
  /// Shows a pattern, words of vam-project, over and over until end(); its first frame is on.
  void light(const Words& pattern);
  /// Moves the stage to an angle of the sinogram.
  void move(int angle_deg);
  /// Frames of vam-capture into NAME.exr; words of it.
  void capture(const std::string& name, const Words& words);
  /// The same over whole turns in the dark; words of vam-stage spin. The angles are appended to angles.jsonl.
  void turn(const std::string& name, int turns, const Words& stage, const Words& words);
  /// The frames of the scan into its record; words of vam-calibrate.
  void measure(const Words& words);
  /// Later frames are corrected for the lag by its record, if one is in force.
  void correct_lag();
  /// 60 deg/s if the stage can, at least the print's speed: a lag shows by the angle turned meanwhile.
  [[nodiscard]] double brisk_deg_s() const;
  /// Every tool, what lights first, politely.
  void end();

  [[nodiscard]] std::string file(const std::string& name) const { return work_ + "/" + name; }
  [[nodiscard]] std::string frames() const { return file(scan_ + ".exr"); }

  const AllOptions& options;
  model::Printer printer;
  double exposure_us = 0;  // of the camera, for the next frames

 private:
  void run(const device::Command& command);
  void start(const device::Command& command);
  void wait(int tick_ms, const std::function<bool()>& done);
  void wait_for_tools();
  [[nodiscard]] device::Command camera(const std::string& name, Words words) const;
  [[nodiscard]] Json ask(const std::string& tool);
  [[nodiscard]] Words projector(const Words& words) const;
  [[nodiscard]] bool is_lit_anew();
  [[noreturn]] void fail(const std::string& tool) const;
  void record(device::Child& tool, int status);

  device::TemporaryFolder scratch_;
  std::string work_;
  std::optional<LogLines> flips_;
  device::EventLog log_;
  model::Calibration records_;
  Words settings_;  // of the devices: as given, but for the records
  std::string scan_, place_;
  std::chrono::steady_clock::time_point begun_;
  double most_deg_s_ = 0;  // of the stage; 0: not known
  device::Talk talk_;
  std::vector<device::Child> tools_;
  std::map<std::string, int> statuses_;  // of those that have ended, since end()
};

}  // namespace vam::calibrate_tool
