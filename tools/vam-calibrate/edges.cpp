// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate edges: where the vial stands, from a sweep of lines through fluorescing resin.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/settings/calibration_record.hpp"
#include "metrology/calibrate/cut_off.hpp"
#include "metrology/calibrate/vial_place.hpp"
#include "metrology/calibrate/wobble.hpp"
#include "optics/chief_ray.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

constexpr double wanted_radius_sigma_percent = 0.2;  // so that a change of 0.5 % is distinguished from noise
// What the fit's own sigma does not know: how far the resin's absorption is as stated, as a part of what it changes;
// and as found on the simulated bench what is left of the noise that is cut off at level 0, as a part of its
// correction, and a beam that is 0.7 mm wide or widens by 2 degrees, as a part of the radius.
constexpr double unsure_of_absorption = 0.2;
constexpr double unsure_of_cut_off = 1.0 / 3;
constexpr double unsure_of_beam = 1e-4;
constexpr double allowed_shift_px = 1;
constexpr double allowed_radius_change = 0.005;

// What differs from the record before, where both speak of the same vial.
void compare_edges(const ScanOptions& options, const model::Calibration& calibration, const metrology::VialEdges& edges,
                   Finding& finding) {
  std::optional<io::CalibrationRecord> before;
  try {
    before = io::current_record(calibration, "edges");
  } catch (const Error& error) {  // its remedy is this scan
    finding.warn_because("not compared with the previous record: " + std::string(error.what()));
  }
  if (!before || before->json->value("vial", "") != calibration.vial) return;
  const double shift_px = edges.axis_column.value - before->value("axis_column");
  const double change = edges.radius_mm.value / before->value("radius") - 1;
  const double sigma_px = std::hypot(edges.axis_column.sigma, before->sigma("axis_column"));
  const auto tell = [&](const std::string& reason) {
    options.accept ? finding.warn_because(reason) : finding.fail_because(reason + " (--accept)");
  };
  if (std::abs(change) > allowed_radius_change) {
    tell("the radius changed by " + format_number(100 * change, 3) + " % since " + before->path +
         "; a different vial requires its own calibration.vial");
  }
  if (std::abs(shift_px) > allowed_shift_px) {
    tell("the centre of the vial moved by " + format_number(shift_px, 3) + " px since " + before->path);
  } else if (std::abs(shift_px) > 3 * sigma_px) {
    finding.warn_because("the centre of the vial moved by " + format_number(shift_px, 3) + " px, " +
                         format_number(std::abs(shift_px) / sigma_px, 3) + " sigma");
  }
}

// The frames of one sweep, by the pattern's frame: the sum of each height's readings.
using Sweep = std::map<int, std::vector<metrology::BandReading>>;

struct Sweeps {
  std::map<long, Sweep> by_angle;  // stage angle in whole degrees, 0...359; -1: not known
  int rows = 0;
  double row_mm = 0;
};

Sweeps read_sweeps(const ScanOptions& options, const model::Printer& printer) {
  Sweeps sweeps;
  each_frame(options, printer, FrameKind::steady, [&](const ScanFrame& frame) {
    const auto readings = metrology::band_readings(frame.image, options.heights);
    const long angle = std::isfinite(frame.angle_deg) ? (std::lround(frame.angle_deg) % 360 + 360) % 360 : -1;
    auto& sum = sweeps.by_angle[angle][frame.shown];
    sum.resize(readings.size());
    for (std::size_t b = 0; b < readings.size(); ++b) sum[b].add(readings[b]);
    sweeps.rows = frame.image.height;
    sweeps.row_mm = frame.pixel_mm;
  });
  return sweeps;
}

std::vector<double> means_of(const std::vector<metrology::BandReading>& readings) {
  std::vector<double> means;
  for (const auto& reading : readings) means.push_back(reading.mean());
  return means;
}

// corrected: for noise that the camera cuts off at level 0.
metrology::SweepScan to_scan(const ScanOptions& options, const Sweeps& sweeps, const Sweep& sweep, bool corrected) {
  metrology::SweepScan scan;
  scan.width_px = options.width_px;
  std::vector<std::vector<metrology::BandReading>> readings(options.heights);
  for (const auto& [shown, sum] : sweep) {
    scan.column.push_back(shown * options.pitch_px + 0.5 * (options.width_px - 1));
    for (std::size_t b = 0; b < readings.size(); ++b) readings[b].push_back(sum[b]);
  }
  for (const auto& band : readings)
    scan.signal.push_back(corrected ? metrology::without_cut_off(band) : means_of(band));
  const int band_rows = sweeps.rows / options.heights;  // as band_readings() cuts them
  for (int b = 0; b < options.heights; ++b) {
    scan.height_mm.push_back((0.5 * options.heights - b - 0.5) * band_rows * sweeps.row_mm);
  }
  return scan;
}

// Combines all angles: the rotation axis from the vial's middles, and means of what does not depend on the angle.
metrology::VialEdges combine(const std::vector<double>& angles, const std::vector<metrology::VialEdges>& all,
                             Finding& finding, const model::Printer& printer) {
  if (all.size() == 1) {
    finding.warn_because(
        "swept at one stage angle: the centre of the vial is recorded as the rotation axis, which ignores its wobble; "
        "sweep at 0, 90, 180 and 270 degrees");
    return all.front();
  }
  const auto each = [&](stats::Measured metrology::VialEdges::*number) {
    std::vector<stats::Measured> numbers;
    for (const auto& edges : all) numbers.push_back(edges.*number);
    return numbers;
  };
  const char* method = "first harmonic of the vial's centre";
  const auto circle = metrology::find_wobble(angles, each(&metrology::VialEdges::axis_column), "edges");
  finding.value("wobble", circle.radius, "px", method);
  finding.value("wobble_phase", circle.phase_deg, "deg", method);
  metrology::VialEdges out = all.front();
  out.edge_px = stats::weighted_mean(each(&metrology::VialEdges::edge_px));
  const double pixel_mm = printer.projector.pixel_mm;
  const double mm = pixel_mm * optics::displacement_rate(optics::projector_view(printer), out.edge_px.value * pixel_mm);
  finding.value("wobble_mm", {circle.radius.value * mm, circle.radius.sigma * mm, circle.radius.n}, "mm", method);
  out.axis_column = circle.mean;
  if (std::all_of(all.begin(), all.end(), [](const auto& edges) { return edges.tilt_deg.n > 0; })) {
    const auto cone = metrology::find_wobble(angles, each(&metrology::VialEdges::tilt_deg), "edges");
    out.tilt_deg = cone.mean;
    finding.value("wobble_tilt", cone.radius, "deg", "first harmonic of the tilt");
    finding.value("wobble_tilt_phase", cone.phase_deg, "deg", "first harmonic of the tilt");
  }
  out.radius_mm = stats::weighted_mean(each(&metrology::VialEdges::radius_mm));
  out.blur_px = stats::weighted_mean(each(&metrology::VialEdges::blur_px));
  return out;
}

metrology::VialEdges in_clear_resin(const metrology::SweepScan& scan, model::Printer printer) {
  printer.resin.absorption_per_mm = 0;
  return metrology::find_edges(scan, printer);
}

}  // namespace

Finding scan_edges(const ScanOptions& options, const model::Printer& printer) {
  const Sweeps sweeps = read_sweeps(options, printer);
  std::vector<double> angles;
  std::vector<metrology::VialEdges> all;
  std::size_t positions = 0;
  double cut_off_mm = 0;   // by how much the correction changes the radius
  double absorbed_mm = 0;  // and the absorption
  double absorbed_px = 0;  // the axis
  for (const auto& [angle, sweep] : sweeps.by_angle) {
    const metrology::SweepScan scan = to_scan(options, sweeps, sweep, true);
    const metrology::SweepScan plain = to_scan(options, sweeps, sweep, false);
    angles.push_back(static_cast<double>(angle));
    all.push_back(metrology::find_edges(scan, printer));
    positions = scan.column.size();
    if (all.size() == 1) {
      const auto clear = in_clear_resin(scan, printer);
      absorbed_mm = all.back().radius_mm.value - clear.radius_mm.value;
      absorbed_px = all.back().axis_column.value - clear.axis_column.value;
    }
    if (scan.signal == plain.signal) continue;
    const double plain_mm = metrology::find_edges(plain, printer).radius_mm.value;
    cut_off_mm += (all.back().radius_mm.value - plain_mm) / static_cast<double>(sweeps.by_angle.size());
  }
  if (all.empty())
    throw Error{Fault::data, options.from + ": no frame shows a single line of the sweep; check --flips"};
  Finding finding;
  auto found = combine(angles, all, finding, printer);
  stats::Measured& radius = found.radius_mm;
  radius.sigma = std::hypot(std::hypot(radius.sigma, unsure_of_absorption * absorbed_mm),
                            unsure_of_cut_off * cut_off_mm, unsure_of_beam * radius.value);
  found.axis_column.sigma = std::hypot(found.axis_column.sigma, unsure_of_absorption * absorbed_px);
  const char* method =
      all.size() > 1 ? "edge fit of fluorescence, mean over the stage angles" : "edge fit of fluorescence";
  finding.value("axis_column", found.axis_column, "px", method);
  finding.value("edge", found.edge_px, "px", method);
  finding.value("radius", found.radius_mm, "mm", "tangent column to radius");
  finding.value("tilt", found.tilt_deg, "deg", "line through the centres by height");
  finding.value("line_blur", found.blur_px, "px", method);
  finding.facts["settings"] = {{"pitch_px", options.pitch_px},
                               {"width_px", options.width_px},
                               {"positions", positions},
                               {"heights", options.heights},
                               {"cut_off_mm", cut_off_mm},
                               {"absorbed_mm", absorbed_mm},
                               {"pixel_mm", printer.projector.pixel_mm},
                               {"throw_mm", model::columns_lens_mm(printer.projector).value_or(0)}};
  if (all.size() > 1) finding.facts["settings"]["stage_angles_deg"] = angles;
  finding.require_sigma("centre", found.axis_column.sigma, wanted_axis_sigma_px, "px");
  finding.require_sigma("radius", 100 * radius.sigma / radius.value, wanted_radius_sigma_percent, "%");
  compare_edges(options, printer.calibration, found, finding);
  return finding;
}

}  // namespace vam::calibrate_tool
