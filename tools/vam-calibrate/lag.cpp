// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate lag: how late the camera's time stamps are, from a bead that turns one way and then the other.
#include "metrology/calibrate/lag.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "device/os/angle_sample.hpp"
#include "io/stream/stream.hpp"
#include "metrology/calibrate/recorded_angle_fit.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

constexpr double before_s = 0.1;  // of the samples before the first and after the last frame

struct MeasuredTurn {
  metrology::CameraAxis axis;
  double speed_deg_s = 0;
};

std::vector<metrology::StagePoint> read_points(const std::string& path) {
  std::vector<metrology::StagePoint> points;
  if (path.empty()) return points;
  long number = 0;
  for (const auto& line : split(io::read_all(path), '\n')) {
    ++number;
    if (line.empty()) continue;
    const device::AngleSample sample = device::parse_angle_line(line, number);
    points.push_back({sample.t_s, sample.angle_deg, sample.sigma_deg});
  }
  return points;
}

metrology::StageCourse course_of(const std::vector<metrology::StagePoint>& points, const std::vector<double>& time_s) {
  const double first_s = *std::min_element(time_s.begin(), time_s.end());
  const double last_s = *std::max_element(time_s.begin(), time_s.end());
  std::vector<metrology::StagePoint> during;
  std::copy_if(points.begin(), points.end(), std::back_inserter(during), [&](const metrology::StagePoint& point) {
    return point.t_s >= first_s - before_s && point.t_s <= last_s + before_s;
  });
  return metrology::StageCourse(during);
}

// What the frames of a turn have in common, the camera's clock and with the stage's samples its course, moves the phase
// as a whole.
MeasuredTurn measure(const ScanOptions& options, const model::Printer& printer,
                     const std::vector<metrology::StagePoint>& points) {
  BeadTurn frames = read_turn(options, printer, metrology::bright_centroids);
  if (frames.time_s.empty() || frames.time_s.front() == 0) {
    throw Error{Fault::data, "lag: the frames have no times; capture them with vam-capture --follow"};
  }
  std::vector<double>& angle_deg = frames.scan.angle_deg;
  std::optional<metrology::StageCourse> course;
  if (!points.empty()) {
    course = course_of(points, frames.time_s);
    std::transform(frames.time_s.begin(), frames.time_s.end(), angle_deg.begin(),
                   [&](double t_s) { return course->angle_deg(t_s); });
  }
  MeasuredTurn turn{metrology::find_camera_axis(frames.scan), metrology::turning_speed_deg_s(frames.time_s, angle_deg)};
  stats::Measured& phase = turn.axis.phase_deg;
  phase.sigma = std::hypot(phase.sigma, turn.speed_deg_s * frames.time_sigma_s);
  if (course) {
    const auto weight = metrology::phase_weights(angle_deg, phase.value);
    phase.sigma = std::hypot(phase.sigma, course->sigma_deg(frames.time_s, weight));
  }
  return turn;
}

}  // namespace

Finding scan_lag(const ScanOptions& options, const model::Printer& printer) {
  ScanOptions other = options;
  other.from = options.reverse;
  const auto points = read_points(options.angles);
  const MeasuredTurn one = measure(options, printer, points);
  const MeasuredTurn two = measure(other, printer, points);
  const auto lag = metrology::camera_lag_ms(one.axis, one.speed_deg_s, two.axis, two.speed_deg_s);
  Finding finding;
  finding.value("camera_lag", lag, "ms", "bead turned in both directions");
  finding.facts["settings"] = {{"forwards_deg_s", one.speed_deg_s}, {"backwards_deg_s", two.speed_deg_s}};
  finding.require_sigma("lag", lag.sigma, wanted_delay_sigma_ms, "ms",
                        "use a higher --speed, or place the bead farther from the axis");
  return finding;
}

}  // namespace vam::calibrate_tool
