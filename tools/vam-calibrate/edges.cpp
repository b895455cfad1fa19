// vam-calibrate edges: where the vial stands, from a sweep of lines through fluorescing resin.
#include "metrology/calibrate/edges.hpp"

#include <cmath>
#include <map>

#include "base/json.hpp"
#include "base/text.hpp"
#include "io/settings/calibration_record.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

constexpr double wanted_radius_sigma = 2e-3;  // of the radius, so that a change of 0.5 % is distinguished from noise
constexpr double allowed_shift_px = 1;
constexpr double allowed_radius_change = 0.005;

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
         "; a different vial needs its own calibration.vial");
  }
  if (std::abs(shift_px) > allowed_shift_px) {
    tell("the centre of the vial moved by " + format_number(shift_px, 3) + " px against " + before->path);
  } else if (std::abs(shift_px) > 3 * sigma_px) {
    finding.warn_because("the centre of the vial moved by " + format_number(shift_px, 3) + " px, " +
                         format_number(std::abs(shift_px) / sigma_px, 3) + " sigma");
  }
}

}  // namespace

Finding scan_edges(const ScanOptions& options, const model::Printer& printer) {
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
      {"pixel_mm", printer.projector.pixel_mm}, {"throw_mm", model::columns_lens_mm(printer.projector).value_or(0)}};
  if (found.axis_column.sigma > wanted_axis_sigma_px) {
    finding.fail_because("the standard deviation of the centre is " + format_number(found.axis_column.sigma, 3) +
                         " px, above " + format_number(wanted_axis_sigma_px));
  }
  if (found.radius_mm.sigma > wanted_radius_sigma * found.radius_mm.value) {
    finding.fail_because("the standard deviation of the radius is " +
                         format_number(100 * found.radius_mm.sigma / found.radius_mm.value, 3) + " %, above " +
                         format_number(100 * wanted_radius_sigma));
  }
  compare_edges(options, printer.calibration, found, finding);
  return finding;
}

}  // namespace vam::calibrate_tool
