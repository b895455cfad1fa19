// vam-calibrate latency: from a flip to its light, from a blinking screen.
#include "metrology/calibrate/latency.hpp"

#include "base/text.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

constexpr int settling_frames = 10;  // until the way of the time stamps from camera to machine is known

}  // namespace

Finding scan_latency(const ScanOptions& options, const model::Printer& printer) {
  metrology::BlinkScan scan;
  const auto flips = read_flips(options.flips);
  for (std::size_t i = 0; i + 1 < flips.size(); ++i) {
    if (flips[i].frame > 0) scan.lit_s.emplace_back(flips[i].t_s, flips[i + 1].t_s);
  }
  scan.exposure_s = 1e-6 * printer.camera.exposure_us;
  int number = 0;
  each_frame(options, printer, Frames::changing, [&](const ScanFrame& frame) {
    if (number++ < settling_frames) return;
    if (frame.time_s < flips.front().t_s || frame.time_s > flips.back().t_s) return;
    scan.begin_s.push_back(frame.time_s - 0.5 * scan.exposure_s);
    scan.light.push_back(mean_level(frame.image));
  });
  const auto found = metrology::measure_latency(scan);
  Finding finding;
  finding.value("latency", found.ms, "ms", "blinking screen");
  finding.facts["contrast"] = found.contrast;
  if (found.ms.sigma > 1)
    finding.fail_because("standard deviation is " + format_number(found.ms.sigma, 3) + " ms, above 1");
  return finding;
}

}  // namespace vam::calibrate_tool
