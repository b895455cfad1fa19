// vam-calibrate lag: how late the camera's time stamps are, from a bead that turns one way and then the other.
#include "metrology/calibrate/lag.hpp"

#include "base/text.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {
constexpr double wanted_sigma_ms = 0.5;
}

Finding scan_lag(const ScanOptions& options, const model::Printer& printer) {
  ScanOptions other = options;
  other.from = options.reverse;
  const BeadTurn forwards = read_turn(options, printer);
  const BeadTurn backwards = read_turn(other, printer);
  const auto speed = [](const BeadTurn& turn) {
    return metrology::turning_speed_deg_s(turn.time_s, turn.scan.angle_deg);
  };
  const auto one = metrology::find_camera_axis(forwards.scan);
  const auto two = metrology::find_camera_axis(backwards.scan);
  const auto lag = metrology::camera_lag_ms(one, speed(forwards), two, speed(backwards));
  Finding finding;
  finding.value("camera_lag", lag, "ms", "bead turned both ways");
  finding.facts["settings"] = {{"forwards_deg_s", speed(forwards)}, {"backwards_deg_s", speed(backwards)}};
  if (lag.sigma > wanted_sigma_ms) {
    finding.fail_because("standard deviation is " + format_number(lag.sigma, 3) + " ms, above " +
                         format_number(wanted_sigma_ms) + "; turn faster, or put the bead further from the axis");
  }
  return finding;
}

}  // namespace vam::calibrate_tool
