#include "vam-capture/scan.hpp"

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>

#include "base/error.hpp"
#include "base/text.hpp"
#include "io/calibration_record.hpp"
#include "io/printer_file.hpp"
#include "io/stream.hpp"
#include "io/view_source.hpp"
#include "metrology/calibrate_axis.hpp"
#include "metrology/calibrate_edges.hpp"
#include "metrology/calibrate_latency.hpp"
#include "metrology/calibrate_response.hpp"
#include "optics/patterns.hpp"

namespace vam::capture_tool {

namespace {

constexpr double wanted_axis_sigma_px = 0.1;
constexpr double wanted_radius_sigma = 2e-3;  // of the radius, so that a change of 0.5 % is told from noise
constexpr double allowed_shift_px = 1;
constexpr double allowed_radius_change = 0.005;
constexpr int settling_frames = 10;  // until the way of the time stamps from camera to machine is known

// Every frame must be there before it is known how the pattern went.
std::vector<double> mean_levels(const Image& image) {
  double sum = 0;
  for (const float value : image.values) sum += value;
  return {sum / static_cast<double>(image.size())};
}

// What differs from the record before, where both speak of the same vial.
void compare_edges(const ScanOptions& options, const model::Calibration& calibration, const metrology::VialEdges& edges,
                   Finding& finding) {
  const auto before = io::current_record(calibration, "edges");
  if (!before || before->json.value("vial", "") != calibration.vial) return;
  const double shift_px = edges.axis_column.value - before->value("axis_column");
  const double change = edges.radius_mm.value / before->value("radius") - 1;
  const double sigma_px = std::hypot(edges.axis_column.sigma, before->sigma("axis_column"));
  const auto tell = [&](const std::string& reason) {
    options.accept ? finding.warn_because(reason) : finding.fail_because(reason + " (--accept)");
  };
  if (std::abs(change) > allowed_radius_change) {
    tell("the radius changed by " + format_number(100 * change, 3) + " % against " + before->path +
         "; another vial has another calibration.vial");
  }
  if (std::abs(shift_px) > allowed_shift_px) {
    tell("the vial's middle moved by " + format_number(shift_px, 3) + " px against " + before->path);
  } else if (std::abs(shift_px) > 3 * sigma_px) {
    finding.warn_because("the vial's middle moved by " + format_number(shift_px, 3) + " px, " +
                         format_number(std::abs(shift_px) / sigma_px, 3) + " sigma");
  }
}

Finding edges(const ScanOptions& options, const model::Printer& printer) {
  std::map<int, std::pair<int, std::vector<double>>> sums;  // by the pattern's frame
  int rows = 0;
  double row_mm = 0;
  each_frame(options, printer, [&](const ScanFrame& frame) {
    const auto means = metrology::band_means(frame.image, options.bands);
    auto& [count, sum] = sums[frame.shown];
    sum.resize(means.size());
    for (std::size_t b = 0; b < means.size(); ++b) sum[b] += means[b];
    ++count;
    rows = frame.image.height;
    row_mm = frame.pixel_mm;
  });
  metrology::SweepScan scan;
  scan.width_px = options.width_px;
  scan.signal.resize(static_cast<std::size_t>(options.bands));
  for (const auto& [shown, sum] : sums) {
    scan.column.push_back(shown * options.pitch_px + 0.5 * (options.width_px - 1));
    for (std::size_t b = 0; b < scan.signal.size(); ++b) scan.signal[b].push_back(sum.second[b] / sum.first);
  }
  const int band_rows = rows / options.bands;  // as band_means() cuts them
  for (int b = 0; b < options.bands; ++b) {
    scan.height_mm.push_back((0.5 * options.bands - b - 0.5) * band_rows * row_mm);
  }
  const auto found = metrology::find_edges(scan, printer);
  Finding finding;
  const char* method = "edge fit of fluorescence";
  finding.value("axis_column", found.axis_column, "px", method);
  finding.value("edge", found.edge_px, "px", method);
  finding.value("radius", found.radius_mm, "mm", "tangent column to radius");
  finding.value("tilt", found.tilt_deg, "deg", "line through the middles by height");
  finding.value("line_blur", found.blur_px, "px", method);
  finding.facts["settings"] = {
      {"pitch_px", options.pitch_px},           {"width_px", options.width_px},
      {"positions", scan.column.size()},        {"heights", options.bands},
      {"pixel_mm", printer.projector.pixel_mm}, {"throw_mm", model::lens_distance_mm(printer.projector).value_or(0)}};
  if (found.axis_column.sigma > wanted_axis_sigma_px) {
    finding.fail_because("the middle is known to " + format_number(found.axis_column.sigma, 3) + " px only, not " +
                         format_number(wanted_axis_sigma_px));
  }
  if (found.radius_mm.sigma > wanted_radius_sigma * found.radius_mm.value) {
    finding.fail_because("the radius is known to " +
                         format_number(100 * found.radius_mm.sigma / found.radius_mm.value, 3) + " % only, not " +
                         format_number(100 * wanted_radius_sigma));
  }
  compare_edges(options, printer.calibration, found, finding);
  return finding;
}

Finding response(const ScanOptions& options, const model::Printer& printer) {
  double dark = 0;
  if (!options.dark.empty()) dark = mean_levels(io::read_field(options.dark)).front();
  std::map<int, std::vector<double>> readings;
  each_frame(options, printer, [&](const ScanFrame& frame) {
    // Without flips the frames of a level follow one another.
    readings[frame.shown].push_back(mean_levels(frame.image).front() - dark);
  });
  std::map<int, std::vector<double>> by_level;
  if (options.flips.empty()) {
    if (readings.size() % static_cast<std::size_t>(options.steps) != 0) {
      throw Error{Fault::data, options.from + ": " + std::to_string(readings.size()) + " frames are not " +
                                   std::to_string(options.steps) + " levels of equally many; see --steps"};
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
  std::string csv = "# of " + printer.calibration.instrument + ", by vam-capture response\ngrey,intensity\n";
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

Finding axis(const ScanOptions& options, const model::Printer& printer) {
  metrology::TurnScan scan;
  double pixel_mm = 0;
  scan.middle.resize(static_cast<std::size_t>(options.bands));
  each_frame(options, printer, [&](const ScanFrame& frame) {
    const auto middles = metrology::bright_middles(frame.image, options.bands);
    for (std::size_t b = 0; b < middles.size(); ++b) scan.middle[b].push_back(middles[b]);
    scan.angle_deg.push_back(frame.angle_deg);
    scan.rows = frame.image.height;
    pixel_mm = frame.pixel_mm;
  });
  const auto found = metrology::find_camera_axis(scan);
  Finding finding;
  const char* method = "first harmonic over the turn";
  finding.value("axis_column", found.column, "px", method);
  finding.value("tilt", found.tilt_deg, "deg", "line through the axes by row");
  finding.value("wobble", found.wobble_px, "px", method);
  finding.value("wobble_phase", found.phase_deg, "deg", method);
  finding.value("wobble_mm", {found.wobble_px.value * pixel_mm, found.wobble_px.sigma * pixel_mm, found.wobble_px.n},
                "mm", method);
  if (found.column.sigma > wanted_axis_sigma_px) {
    finding.fail_because("the axis is known to " + format_number(found.column.sigma, 3) + " px only, not " +
                         format_number(wanted_axis_sigma_px));
  }
  return finding;
}

Finding latency(const ScanOptions& options, const model::Printer& printer) {
  if (options.flips.empty()) throw Error{Fault::usage, "latency: needs --flips, the log of the blinking vam-project"};
  metrology::BlinkScan scan;
  const auto flips = read_flips(options.flips);
  for (std::size_t i = 0; i + 1 < flips.size(); ++i) {
    if (flips[i].frame > 0) scan.lit_s.emplace_back(flips[i].t_s, flips[i + 1].t_s);
  }
  scan.exposure_s = 1e-6 * printer.camera.exposure_us;
  int number = 0;
  each_frame(options, printer, [&](const ScanFrame& frame) {
    if (number++ < settling_frames) return;
    if (frame.time_s < flips.front().t_s || frame.time_s > flips.back().t_s) return;
    scan.begin_s.push_back(frame.time_s - 0.5 * scan.exposure_s);
    scan.light.push_back(mean_levels(frame.image).front());
  });
  const auto found = metrology::measure_latency(scan);
  Finding finding;
  finding.value("latency", found.ms, "ms", "blinking screen");
  finding.facts["contrast"] = found.contrast;
  if (found.ms.sigma > 1) finding.fail_because("known to " + format_number(found.ms.sigma, 3) + " ms only, not 1");
  return finding;
}

using Scan = Finding (*)(const ScanOptions&, const model::Printer&);
const std::map<std::string, Scan>& scans() {
  static const std::map<std::string, Scan> all{{"edges", edges},    {"response", response}, {"flat", scan_flat},
                                               {"beam", scan_beam}, {"axis", axis},         {"latency", latency}};
  return all;
}

void add_input(cli::App& scan, ScanOptions& options, bool with_flips) {
  scan.option("--from", "FILE", options.from,
              "The frames: an EXR stack or folder of vam-capture, or a folder of pictures.");
  if (with_flips) {
    scan.option("--flips", "FILE", options.flips,
                "Log of vam-project while they were taken: tells which picture each frame shows. Without it frame n "
                "shows picture n.");
  }
  scan.option("--devices", "FILE", options.devices,
              "JSON for the record, like {\"camera\": ...}: what identify says of each device that took part.");
  cli::add_printer(scan, options.printer);
}

}  // namespace

void add_scans(cli::App& app, ScanOptions& options, std::string& chosen) {
  auto& edge = app.subcommand("edges", "where the vial stands: edges, radius and tilt from a sweep", chosen);
  add_input(edge, options, true);
  edge.option("--pitch", "PX", options.pitch_px, {1, 1000}, "Step of the sweep.");
  edge.option("--width", "PX", options.width_px, {1, 1000}, "Of its line.");
  edge.option("--bands", "N", options.bands, {1, 100}, "Heights that are measured apart.");
  edge.flag("--accept", options.accept, "Also when the vial moved or changed since the record before.");
  auto& ramp = app.subcommand("response", "grey level to light, from a ramp of uniform levels", chosen);
  add_input(ramp, options, true);
  ramp.option("--steps", "N", options.steps, {2, 65536}, "Levels of the ramp.");
  ramp.option("--dark", "FILE", options.dark, "Picture or stack without any light.");
  auto& even = app.subcommand("flat", "the camera's flat field, from frames of an even scene", chosen);
  add_input(even, options, true);
  even.option("--dark", "FILE", options.dark, "Picture or stack without any light.");
  auto& line = app.subcommand(
      "beam", "width and divergence of a lit line, on a sensor moved along the light or in resin", chosen);
  add_input(line, options, true);
  line.flag("--side", options.side,
            "The frames are the camera's, of a lit row in fluorescing resin (vam-project --pattern row).");
  line.option("--dark", "FILE", options.dark, "Picture or stack without the projector's light.");
  line.option("--first", "MM", options.first_mm, cli::any, "Plane of the first frame, from the rotation axis.");
  line.option("--step", "MM", options.step_mm, cli::any, "From plane to plane.");
  line.option("--pixel", "MM", options.pixel_mm, cli::non_negative, "Of the bare sensor; with --side at the axis.");
  auto& turn = app.subcommand("axis", "rotation axis and wobble in the camera's frames, over a turn", chosen);
  add_input(turn, options, false);
  turn.option("--step", "DEG", options.step_deg, cli::any, "Angle between frames that carry none.");
  turn.option("--bands", "N", options.bands, {1, 100}, "Heights that are measured apart.");
  add_input(app.subcommand("latency", "from a flip to its light, from a blinking screen", chosen), options, true);
  auto& check =
      app.subcommand("check", "print the current records as JSON; status 65 when one must not be used", chosen);
  check.option("--need", "SCAN", options.needed, "A record of this scan must be there; may be repeated.");
  check.option("--devices", "FILE", options.devices, "Refuse records made with devices of other serial numbers.");
  cli::add_printer(check, options.printer);
}

bool is_scan(const std::string& command) { return command == "check" || scans().contains(command); }

void run_scan(const cli::App& app, const ScanOptions& given, const std::string& command) {
  ScanOptions options = given;
  options.command = command;
  model::Printer printer = io::load_printer(options.printer.file, options.printer.sets, io::Records::ignore);
  if (command == "check") return check_records(options, printer.calibration);
  // Where the axis stands in the camera's picture, as measured before.
  const auto axis_record = io::current_record(printer.calibration, "axis");
  if (axis_record && command != "axis" && io::objection(*axis_record, printer.calibration, io::utc_seconds()).empty()) {
    printer.camera.axis_column = axis_record->value("axis_column");
  }
  // A latency that was measured before helps to tell which picture a frame shows.
  const auto known = io::current_record(printer.calibration, "latency");
  if (known && command != "latency" && io::objection(*known, printer.calibration, io::utc_seconds()).empty()) {
    printer.projector.latency_ms = known->value("latency");
  }
  if (options.from.empty()) throw Error{Fault::usage, command + ": no frames; name them with --from"};
  keep(app, options, printer.calibration, command, scans().at(command)(options, printer));
}

}  // namespace vam::capture_tool
