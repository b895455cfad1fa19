// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate latency: from a flip to its light, from a blinking screen.
#include "metrology/calibrate/latency.hpp"

#include <algorithm>
#include <cmath>

#include "base/stats/range.hpp"
#include "base/text/json.hpp"
#include "base/text/utc.hpp"
#include "io/settings/calibration_record.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

constexpr int settling_frames = 10;  // until the way of the time stamps from camera to machine is known

// Uncertainty of the camera's lag, for which the times of the frames were corrected: its error is that of the latency.
double lag_sigma_ms(const model::Calibration& calibration) {
  const auto lag = io::current_record(calibration, "lag");
  if (!lag || !io::objection(*lag, calibration, utc_seconds()).empty()) return 0;
  const Json values = lag->json->value("values", Json::object());
  return lag->sigma(values.contains("camera_lag") ? "camera_lag" : "camera_latency");
}

}  // namespace

Finding scan_latency(const ScanOptions& options, const model::Printer& printer) {
  metrology::BlinkScan scan;
  const auto flips = read_flips(options.flips);
  for (std::size_t i = 0; i + 1 < flips.size(); ++i) {
    if (flips[i].frame > 0) scan.lit_s.emplace_back(flips[i].t_s, flips[i + 1].t_s);
  }
  scan.exposure_s = 1e-6 * printer.camera.exposure_us;
  double clock_sigma_s = 0;
  int number = 0;
  each_frame(options, printer, FrameKind::changing, [&](const ScanFrame& frame) {
    if (number++ < settling_frames) return;
    if (frame.time_s < flips.front().t_s || frame.time_s > flips.back().t_s) return;
    clock_sigma_s = std::max(clock_sigma_s, frame.time_sigma_s);
    scan.begin_s.push_back(frame.time_s - 0.5 * scan.exposure_s);
    scan.light.push_back(stats::mean_value(frame.image.values));
  });
  auto found = metrology::measure_latency(scan);
  found.ms.sigma = std::hypot(found.ms.sigma, 1e3 * clock_sigma_s, lag_sigma_ms(printer.calibration));
  Finding finding;
  finding.value("latency", found.ms, "ms", "blinking screen");
  finding.facts["contrast"] = found.contrast;
  finding.require_sigma("latency", found.ms.sigma, wanted_delay_sigma_ms, "ms");
  return finding;
}

}  // namespace vam::calibrate_tool
