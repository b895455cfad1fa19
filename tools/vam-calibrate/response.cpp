// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate response: grey level to light, from a ramp of uniform levels.
#include "metrology/calibrate/response.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/range.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/image/view_source.hpp"
#include "io/stream/stream.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

/// Light of the frames of each level: the pattern's frames are levels; without flips those of a level follow one
/// another.
std::map<int, std::vector<double>> by_level(const ScanOptions& options, std::map<int, std::vector<double>> readings) {
  if (!options.flips.empty()) return readings;
  if (readings.size() % static_cast<std::size_t>(options.steps) != 0) {
    throw Error{Fault::data, options.from + ": " + std::to_string(readings.size()) + " frames cannot be split into " +
                                 std::to_string(options.steps) + " levels of equal length; check --steps"};
  }
  const int each = count_of(readings) / options.steps;
  std::map<int, std::vector<double>> levels;
  for (const auto& [n, light] : readings) levels[n / each].push_back(light.front());
  return levels;
}

// Black that is not distinguished from the dark frames gives a lower limit: the contrast for the most that it may be.
void add_contrast(const stats::Measured& black, Finding& finding) {
  constexpr double resolved = 1.0 / 4096;  // of full: of a camera of 12 bits
  if (black.value > 3 * black.sigma && black.value > resolved) {
    const stats::Measured contrast{1 / black.value, black.sigma / std::pow(black.value, 2), black.n};
    return finding.value("contrast", contrast, "1", "full grey over black");
  }
  const double most = std::max(black.value + 2 * black.sigma, resolved);
  finding.value("contrast", {1 / most, 0, black.n}, "1", "lower limit: black is not distinguished from no light");
}

Finding finding_of(const metrology::ResponseCurve& curve, const std::string& instrument) {
  Finding finding;
  add_contrast(curve.intensity.front(), finding);
  std::string csv = "# of " + instrument + ", by vam-calibrate response\ngrey,intensity\n";
  Json levels = Json::array();
  for (std::size_t i = 0; i < curve.grey.size(); ++i) {
    csv += format_number(curve.grey[i]) + "," + format_number(curve.intensity[i].value, 9) + "\n";
    levels.push_back(measured_json(curve.intensity[i], "fraction of full", "mean of the camera image, monotone"));
    levels.back()["grey"] = curve.grey[i];
  }
  finding.facts["response"] = levels;
  finding.products.push_back({"response", ".csv", [csv](const std::string& path) { io::write_text(path, csv); }});
  return finding;
}

}  // namespace

Finding scan_response(const ScanOptions& options, const model::Printer& printer) {
  double dark = 0;
  if (!options.dark.empty()) dark = stats::mean_value(io::read_field(options.dark).values);
  std::map<int, std::vector<double>> readings;
  each_frame(options, printer, FrameKind::steady, [&](const ScanFrame& frame) {
    readings[frame.shown].push_back(stats::mean_value(frame.image.values) - dark);
  });
  metrology::ResponseScan scan;
  const int full = (1 << printer.projector.bits) - 1;
  for (const auto& [level, light] : by_level(options, std::move(readings))) {
    scan.grey.push_back(std::round(static_cast<double>(level) / (options.steps - 1) * full));
    scan.light.push_back(light);
  }
  return finding_of(metrology::measure_response(scan), printer.calibration.instrument);
}

}  // namespace vam::calibrate_tool
