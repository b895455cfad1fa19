// SPDX-License-Identifier: GPL-3.0-or-later
// A resin's absorbance height and gelation threshold from cured thicknesses.
#include "resin/working_curve.hpp"

#include "base/json.hpp"
#include "base/text.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/report.hpp"
#include "io/stream/stream.hpp"
#include "vam-curethrough/figures.hpp"
#include "vam-curethrough/subcommands.hpp"

namespace vam::curethrough {

namespace {

Json interval(const resin::Interval& range) { return Json::array({range.low, range.high}); }

Json figures(const resin::WorkingCurve& curve, const std::vector<resin::CuredSample>& samples) {
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

std::string line(const char* what, double value, const resin::Interval& range, const char* unit) {
  return std::string(what) + format_number(value, 5) + " " + unit + "  (" + format_number(range.low, 5) + " to " +
         format_number(range.high, 5) + ")\n";
}

std::string table_of(const resin::WorkingCurve& curve, const io::CsvTable& csv,
                     const std::vector<resin::CuredSample>& samples) {
  std::string text = "thickness = h_a log10(E / E_c), logarithm to base 10; " + std::to_string(curve.samples) +
                     " samples at " + std::to_string(curve.exposures) + " exposures; intervals of " +
                     format_number(100 * curve.confidence) + " %\n";
  text += line("h_a    ", curve.absorbance_height_um, curve.absorbance_height_range_um, "um per decade");
  text += "D_p    " + format_number(curve.penetration_depth_um, 5) + " um to 1/e (h_a / ln 10)\n";
  text += line("E_c    ", curve.critical_exposure_mj_cm2, curve.critical_exposure_range_mj_cm2, "mJ/cm2");
  text += line("D_c    ", curve.gel_dose_mj_cm3, curve.gel_dose_range_mj_cm3, "mJ/cm3");
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

}  // namespace

void declare(cli::App& app, WorkingCurveOptions& options) {
  app.positional("DATA", options.input, "CSV with the columns exposure_mj_cm2,thickness_um; one line per measurement.")
      .reads();
  app.option("--confidence", "FRACTION", options.confidence, {0.5, 0.9999}, "Confidence level of the intervals.");
  app.option("--plot", "FILE", options.plot, "Plot the samples, the line and its interval (.png, .pdf or .svg).")
      .writes();
  cli::add_report(app, options.report);
}

void run(const cli::App&, const cli::App&, const WorkingCurveOptions& options) {
  const io::CsvTable csv = io::read_csv(options.input, {"exposure_mj_cm2", "thickness_um"});
  std::vector<resin::CuredSample> samples;
  for (std::size_t row = 0; row < csv.rows.size(); ++row) samples.push_back({csv.number(row, 0), csv.number(row, 1)});
  const resin::WorkingCurve curve = resin::fit_working_curve(samples, options.confidence);
  if (options.report != "-") io::write_text("-", table_of(curve, csv, samples));
  if (!options.plot.empty()) draw_working_curve(options.plot, samples, curve);
  io::write_report(options.report, "vam-curethrough-working-curve", figures(curve, samples));
}

}  // namespace vam::curethrough
