// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate cure-depth: a resin's absorbance height and gelation threshold from cured thicknesses.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/stats/distributions.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "cli/common.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "plot/plot.hpp"
#include "plot/save.hpp"
#include "resin/working_curve.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

struct CureDepthOptions {
  std::string input = "-";
  double confidence = 0.95;
  std::string plot;
  std::string report;
};

Json interval(const resin::Interval& range) { return Json::array({range.low, range.high}); }

Json figures_of(const resin::WorkingCurve& curve, const std::vector<resin::CuredSample>& samples) {
  Json report{{"logarithm_base", 10},
              {"confidence", curve.confidence},
              {"samples", curve.samples},
              {"exposures", curve.exposures},
              {"absorbance_height_um", curve.absorbance_height_um},
              {"absorbance_height_range_um", interval(curve.absorbance_height_range_um)},
              {"penetration_depth_um", curve.penetration_depth_um},
              {"absorption_per_mm", 1e3 / curve.penetration_depth_um},
              {"critical_exposure_mj_cm2", curve.critical_exposure_mj_cm2},
              {"critical_exposure_range_mj_cm2", interval(curve.critical_exposure_range_mj_cm2)},
              {"gel_dose_mj_cm3", curve.gel_dose_mj_cm3},
              {"gel_dose_range_mj_cm3", interval(curve.gel_dose_range_mj_cm3)},
              {"residual_sd_um", curve.residual_sd_um},
              {"repeat_sd_um", curve.repeat_sd_um},
              {"lack_of_fit_p", curve.lack_of_fit_p},
              {"r_squared", curve.r_squared}};
  Json outliers = Json::array();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!curve.outlier[i]) continue;
    outliers.push_back({{"sample", i + 1},
                        {"exposure_mj_cm2", samples[i].exposure_mj_cm2},
                        {"thickness_um", samples[i].thickness_um},
                        {"residual_um", curve.residual_um[i]}});
  }
  report["outliers"] = outliers;
  return report;
}

std::string line_of(const char* what, double value, const resin::Interval& range, const char* unit) {
  return std::string(what) + format_number(value, 5) + " " + unit + "  (" + format_number(range.low, 5) + " to " +
         format_number(range.high, 5) + ")\n";
}

std::string table_of(const resin::WorkingCurve& curve, const io::CsvTable& csv,
                     const std::vector<resin::CuredSample>& samples) {
  std::string text = "thickness = h_a log10(E / E_c), logarithm to base 10; " + std::to_string(curve.samples) +
                     " samples at " + std::to_string(curve.exposures) + " exposures; intervals of " +
                     format_number(100 * curve.confidence) + " %\n";
  text += line_of("h_a    ", curve.absorbance_height_um, curve.absorbance_height_range_um, "um per decade");
  text += "D_p    " + format_number(curve.penetration_depth_um, 5) + " um to 1/e (h_a / ln 10)\n";
  text += line_of("E_c    ", curve.critical_exposure_mj_cm2, curve.critical_exposure_range_mj_cm2, "mJ/cm2");
  text += line_of("D_c    ", curve.gel_dose_mj_cm3, curve.gel_dose_range_mj_cm3, "mJ/cm3");
  text += "scatter " + format_number(curve.residual_sd_um, 4) + " um about the line";
  if (curve.repeat_sd_um > 0) {
    text += ", " + format_number(curve.repeat_sd_um, 4) +
            " um between repeats (lack of fit: p = " + format_number(curve.lack_of_fit_p, 3) + ")";
  }
  text += "\n";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!curve.outlier[i]) continue;
    text += "outlier, kept: line " + std::to_string(csv.lines[i]) + ", " + format_number(samples[i].exposure_mj_cm2) +
            " mJ/cm2, " + format_number(samples[i].thickness_um) + " um, " + format_number(curve.residual_um[i], 4) +
            " um off the line\n";
  }
  return text;
}

/// The line and its confidence interval.
struct LineBand {
  std::vector<double> at, line, low, high;
};

LineBand band_of(const std::vector<resin::CuredSample>& samples, const resin::WorkingCurve& curve, double most) {
  double mean = 0;
  for (const auto& sample : samples) mean += std::log10(sample.exposure_mj_cm2) / static_cast<double>(samples.size());
  double spread = 0;
  for (const auto& sample : samples) spread += std::pow(std::log10(sample.exposure_mj_cm2) - mean, 2);
  const double count = curve.samples;
  const double t = stats::student_quantile(1 - curve.confidence, count - 2);
  LineBand band;
  const double first = std::log10(0.8 * curve.critical_exposure_mj_cm2);
  const double last = std::log10(1.3 * most);
  constexpr int steps = 200;
  for (int i = 0; i <= steps; ++i) {
    const double power = first + (last - first) * i / steps;
    const double value = curve.absorbance_height_um * (power - std::log10(curve.critical_exposure_mj_cm2));
    const double error = t * curve.residual_sd_um * std::sqrt(1 / count + std::pow(power - mean, 2) / spread);
    band.at.push_back(std::pow(10, power));
    band.line.push_back(value);
    band.low.push_back(value - error);
    band.high.push_back(value + error);
  }
  return band;
}

void draw(const std::string& path, const std::vector<resin::CuredSample>& samples, const resin::WorkingCurve& curve) {
  std::array<std::vector<double>, 2> x;  // kept, flagged
  std::array<std::vector<double>, 2> y;
  double most = 0;
  double highest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    x[curve.outlier[i]].push_back(samples[i].exposure_mj_cm2);
    y[curve.outlier[i]].push_back(samples[i].thickness_um);
    most = std::max(most, samples[i].exposure_mj_cm2);
    highest = std::max(highest, samples[i].thickness_um);
  }
  const LineBand band = band_of(samples, curve, most);
  plot::Plot plot;
  plot.title = "h_a = " + format_number(curve.absorbance_height_um, 4) +
               " µm per decade (log10), D_c = " + format_number(curve.gel_dose_mj_cm3, 4) + " mJ/cm³";
  plot.x = {"exposure E (mJ/cm²)", band.at.front(), band.at.back(), true};
  plot.y = {"cured thickness (µm)", 0, 1.12 * highest};
  plot.series = {{"least squares", band.at, band.line, plot::paint::blue, plot::SeriesStyle::line},
                 {format_number(100 * curve.confidence) + " % of the line", band.at, band.low, plot::paint::grey,
                  plot::SeriesStyle::line},
                 {"", band.at, band.high, plot::paint::grey, plot::SeriesStyle::line},
                 {"samples", x[0], y[0], plot::paint::black, plot::SeriesStyle::points}};
  if (!x[1].empty())
    plot.series.push_back({"outliers, kept in the fit", x[1], y[1], Rgb{214, 39, 40}, plot::SeriesStyle::points});
  plot::save(path, plot::draw(plot));
}

void declare(cli::App& app, CureDepthOptions& options) {
  app.positional("DATA", options.input, "CSV with the columns exposure_mj_cm2,thickness_um; one line per measurement.")
      .reads();
  app.option("--confidence", "FRACTION", options.confidence, {0.5, 0.9999}, "Confidence level of the intervals.");
  app.option("--plot", "FILE", options.plot, "Plot the samples, the line and its interval (.png, .pdf or .svg).")
      .writes();
  cli::add_report(app, options.report);
}

void run(const cli::App& /*app*/, CureDepthOptions& options) {
  const io::CsvTable csv = io::read_csv(options.input, {"exposure_mj_cm2", "thickness_um"});
  std::vector<resin::CuredSample> samples;
  for (std::size_t row = 0; row < csv.rows.size(); ++row) samples.push_back({csv.number(row, 0), csv.number(row, 1)});
  const resin::WorkingCurve curve = resin::fit_working_curve(samples, options.confidence);
  if (options.report != "-") io::write_text("-", table_of(curve, csv, samples));
  if (!options.plot.empty()) draw(options.plot, samples, curve);
  io::write_report(options.report, "vam-cure-depth", figures_of(curve, samples));
}

}  // namespace

void add_cure_depth(cli::App& app) {
  app.subcommand<CureDepthOptions>("cure-depth", "absorbance height and gelation threshold, from cured thicknesses",
                                   declare, run);
}

}  // namespace vam::calibrate_tool
