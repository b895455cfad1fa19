// vam-calibrate response: grey level to light, from a ramp of uniform levels.
#include "metrology/calibrate/response.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "io/image/view_source.hpp"
#include "io/stream/stream.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

Finding scan_response(const ScanOptions& options, const model::Printer& printer) {
  double dark = 0;
  if (!options.dark.empty()) dark = mean_level(io::read_field(options.dark));
  std::map<int, std::vector<double>> readings;
  each_frame(options, printer, [&](const ScanFrame& frame) {
    // Without flips the frames of a level follow one another.
    readings[frame.shown].push_back(mean_level(frame.image) - dark);
  });
  std::map<int, std::vector<double>> by_level;
  if (options.flips.empty()) {
    if (readings.size() % static_cast<std::size_t>(options.steps) != 0) {
      throw Error{Fault::data, options.from + ": " + std::to_string(readings.size()) + " frames cannot be split into " +
                                   std::to_string(options.steps) + " levels of equal length; see --steps"};
    }
    const int each = static_cast<int>(readings.size()) / options.steps;
    for (const auto& [n, light] : readings) by_level[n / each].push_back(light.front());
  } else {
    by_level = readings;
  }
  metrology::ResponseScan scan;
  const int full = (1 << printer.projector.bits) - 1;
  for (const auto& [level, light] : by_level) {
    scan.grey.push_back(std::round(static_cast<double>(level) / (options.steps - 1) * full));
    scan.light.push_back(light);
  }
  const auto curve = metrology::measure_response(scan);
  Finding finding;
  finding.value("contrast",
                {1 / std::max(curve.intensity.front().value, 1e-9),
                 curve.intensity.front().sigma / std::pow(std::max(curve.intensity.front().value, 1e-9), 2),
                 curve.intensity.front().n},
                "1", "full grey over black");
  std::string csv = "# of " + printer.calibration.instrument + ", by vam-calibrate response\ngrey,intensity\n";
  Json levels = Json::array();
  for (std::size_t i = 0; i < curve.grey.size(); ++i) {
    csv += format_number(curve.grey[i]) + "," + format_number(curve.intensity[i].value, 9) + "\n";
    levels.push_back({{"grey", curve.grey[i]},
                      {"value", curve.intensity[i].value},
                      {"unit", "of full"},
                      {"sigma", curve.intensity[i].sigma},
                      {"n", curve.intensity[i].n},
                      {"method", "camera mean, monotone"}});
  }
  finding.facts["response"] = levels;
  finding.products.push_back({"response", ".csv", [csv](const std::string& path) { io::write_text(path, csv); }});
  return finding;
}

}  // namespace vam::calibrate_tool
