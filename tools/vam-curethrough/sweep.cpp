// SPDX-License-Identifier: GPL-3.0-or-later
// Parameter study on a ladder of features.
#include "resin/curethrough/sweep.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "session/printer.hpp"
#include "vam-curethrough/figures.hpp"
#include "vam-curethrough/print.hpp"
#include "vam-curethrough/subcommands.hpp"

namespace vam::curethrough {

namespace {

struct SweepOptions {
  PrintOptions print;
  std::string ranges = "df_over_dc=1..8,omega_max=1..5";
  std::vector<double> heights{4, 6, 8, 10, 14, 20, 40};
  double slice_um = 50;
  std::optional<double> gel_dose_mj_cm3;
  std::string plot;
  std::string report;
};

double number(const std::string& text, const std::string& whole) {
  const auto value = parse_number(text);
  if (!value || std::isnan(*value)) throw Error{Fault::usage, whole + ": '" + text + "' is not a number"};
  return *value;
}

// "1..8", "1..8..0.5" or "1/2/inf".
std::vector<double> values_of(const std::string& text, const std::string& whole) {
  std::vector<double> values;
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos) {
    for (const std::string& part : split(text, '/')) values.push_back(number(part, whole));
    return values;
  }
  const std::size_t more = text.find("..", dots + 2);
  const double low = number(text.substr(0, dots), whole);
  const double high = number(text.substr(dots + 2, more == std::string::npos ? more : more - dots - 2), whole);
  const double step = more == std::string::npos ? 1 : number(text.substr(more + 2), whole);
  const double count = std::floor((high - low) / step + 1e-9);
  if (!(step > 0) || !(count >= 0 && count < 1000)) {
    throw Error{Fault::usage, whole + ": '" + text + "' is not a rising range of at most 1000 values"};
  }
  for (int i = 0; i <= static_cast<int>(count); ++i) values.push_back(low + i * step);
  return values;
}

constexpr const char* dose_ratio = "df_over_dc";

void parse(const std::string& ranges, resin::Study& study) {
  study.omega_max = {1};
  for (const std::string& part : split(ranges, ',')) {
    const std::size_t equals = part.find('=');
    const std::string key = part.substr(0, equals);
    if (equals == std::string::npos || (key != dose_ratio && key != "omega_max")) {
      throw Error{Fault::usage, ranges + ": '" + part + "' is neither df_over_dc=FROM..TO nor omega_max=FROM..TO" +
                                    did_you_mean(key, {dose_ratio, "omega_max"})};
    }
    (key == dose_ratio ? study.dose_factors : study.omega_max) = values_of(part.substr(equals + 1), ranges);
  }
}

Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json("inf"); }

Json figures(const std::vector<resin::StudyPoint>& points, const resin::Study& study) {
  Json list = Json::array();
  for (const resin::StudyPoint& point : points) {
    Json entry{
        {"df_over_dc", point.dose_factor}, {"omega_max", json_number(point.omega_max)}, {"printable", point.printable}};
    if (point.printable) {
      entry["extra_slices"] = point.extra_slices;
      entry["ratio"] = point.ratio;
      entry["sizes"] = Json::array();
      for (const resin::SizeRatio& size : point.sizes) {
        entry["sizes"].push_back({{"height_um", size.height * study.process.slice_um},
                                  {"uncorrected_error_um", size.plain_um},
                                  {"corrected_error_um", size.corrected_um},
                                  {"ratio", size.ratio()}});
      }
    }
    list.push_back(entry);
  }
  return {{"process", to_json(study.process)}, {"gel_dose_mj_cm3", study.gel_dose_mj_cm3}, {"points", list}};
}

std::string csv_of(const std::vector<resin::StudyPoint>& points, double slice_um) {
  std::string text = "df_over_dc,omega_max,height_um,uncorrected_error_um,corrected_error_um,ratio\n";
  for (const resin::StudyPoint& point : points) {
    const std::string head = format_number(point.dose_factor) + "," + format_number(point.omega_max) + ",";
    if (!point.printable) text += head + ",,,\n";
    for (const resin::SizeRatio& size : point.sizes) {
      text += head + format_number(size.height * slice_um) + "," + format_number(size.plain_um) + "," +
              format_number(size.corrected_um) + "," + format_number(size.ratio()) + "\n";
    }
  }
  return text;
}

std::vector<int> whole_heights(const std::vector<double>& heights) {
  std::vector<int> whole;
  for (const double height : heights) {
    if (!(height >= 1 && height <= 10000) || height != std::floor(height)) {
      throw Error{Fault::usage,
                  "--rung-heights: " + format_number(height) + " is not a number of slices from 1 to 10000"};
    }
    whole.push_back(static_cast<int>(height));
  }
  if (whole.empty()) throw Error{Fault::usage, "--rung-heights: no values"};
  return whole;
}

void declare(cli::App& app, SweepOptions& options) {
  app.positional(
      "RANGES", options.ranges,
      "Parameters to vary: df_over_dc, the ratio of the assumed full-cure dose D_f to the gelation threshold "
      "D_c, and omega_max. Each is FROM..TO, FROM..TO..STEP or VALUE/VALUE/....");
  app.option("--rung-heights", "SLICES,...", options.heights, 0,
             "Heights of the rungs of the ladder; each gap is as high as the next rung.");
  app.option("--slice-height", "UM", options.slice_um, {1, 10000}, "Slice height.");
  app.option("--gel-dose", "MJ_CM3", options.gel_dose_mj_cm3, cli::positive,
             "Gelation threshold D_c of the working curve.");
  app.default_is("resin.critical_dose_mj_cm3, else a fifth of the full-cure dose");
  app.option("--plot", "FILE", options.plot, "Plot the error ratios against df_over_dc (.png, .pdf or .svg).").writes();
  add_print(app, options.print);
  app.group("Report and performance");
  cli::add_report(app, options.report);
  cli::add_threads(app);
}

void run(const cli::App& /*app*/, SweepOptions& options) {
  if (session::print_printer(options.print.printer)) return;
  resin::Study study;
  parse(options.ranges, study);
  const PrintSettings print = resolve(options.print, options.slice_um);
  study.process = print.process;
  const auto& critical = print.printer.resin.critical_dose_mj_cm3;
  const double fifth = study.process.full_cure_dose_mj_cm3 / resin::full_cure_factor;
  study.gel_dose_mj_cm3 = options.gel_dose_mj_cm3.value_or(critical.value_or(fifth));
  const auto points = resin::run_study(resin::graded_ladder(whole_heights(options.heights)), study);
  if (options.report != "-") io::write_text("-", csv_of(points, options.slice_um));
  if (!options.plot.empty()) draw_study(options.plot, points, options.slice_um);
  io::write_report(options.report, "vam-curethrough-sweep", figures(points, study));
}

}  // namespace

void add_sweep(cli::App& app) { app.subcommand<SweepOptions>("sweep", "study parameters on a ladder", declare, run); }

}  // namespace vam::curethrough
