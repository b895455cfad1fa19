// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate photodiode: the projector's grey response from readings of a photodiode.
#include <cmath>
#include <string>
#include <vector>

#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "cli/common.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "plot/plot.hpp"
#include "plot/save.hpp"
#include "resin/response.hpp"
#include "resin/response_fit.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

struct PhotodiodeOptions {
  std::string input = "-";
  std::string output = "-";
  double dark = 0;
  double scale = 1;
  std::string plot;
  std::string report;
};

void declare(cli::App& app, PhotodiodeOptions& options) {
  app.positional("DATA", options.input, "CSV with the columns grey,reading; one line per measurement.").reads();
  cli::add_output(app, options.output);
  app.option("--dark-reading", "READING", options.dark, cli::any,
             "Reading of the photodiode without light; it is subtracted.");
  app.option("--irradiance-per-reading", "MW_CM2", options.scale, cli::positive, "Irradiance per unit of reading.");
  app.option("--plot", "FILE", options.plot, "Plot the mean readings and the response curve (.png, .pdf or .svg).")
      .writes();
  cli::add_report(app, options.report);
}

void draw(const std::string& path, const model::ResponseTable& table) {
  const resin::Response response(table);
  const double full = table.grey.back();
  const double light = table.intensity.back();
  constexpr int steps = 300;
  std::vector<double> at, curve;
  for (int i = 0; i <= steps; ++i) {
    at.push_back(full * i / steps);
    curve.push_back(response.intensity(static_cast<double>(i) / steps) * light);
  }
  plot::Plot plot;
  plot.title = "grey response";
  plot.x = {"grey", 0, full};
  plot.y = {"intensity", 0, 1.05 * light};
  plot.series = {{"monotone cubic", at, curve, plot::paint::blue, plot::SeriesStyle::line},
                 {"mean readings", table.grey, table.intensity, plot::paint::black, plot::SeriesStyle::points}};
  plot::save(path, plot::draw(plot));
}

void run(const cli::App& app, PhotodiodeOptions& options) {
  const io::CsvTable csv = io::read_csv(options.input, {"grey", "reading"});
  std::vector<resin::PhotodiodeReading> readings;
  for (std::size_t row = 0; row < csv.rows.size(); ++row) readings.push_back({csv.number(row, 0), csv.number(row, 1)});
  resin::ResponseFit fit = resin::fit_response(readings, options.dark, csv.source);
  std::string text = "# " + app.history() + "\ngrey,intensity\n";
  for (std::size_t i = 0; i < fit.table.grey.size(); ++i) {
    fit.table.intensity[i] *= options.scale;
    text += format_number(fit.table.grey[i], 9) + "," + format_number(fit.table.intensity[i], 9) + "\n";
  }
  io::write_text(options.output, text);
  if (!options.plot.empty()) draw(options.plot, fit.table);
  Json report{{"levels", fit.table.grey.size()},
              {"readings", readings.size()},
              {"contrast", nullptr},
              {"gamma", fit.gamma},
              {"noise", fit.noise},
              {"pooled_levels", fit.pooled},
              {"min_intensity", fit.table.intensity.front()},
              {"max_intensity", fit.table.intensity.back()}};
  if (std::isfinite(fit.contrast)) report["contrast"] = fit.contrast;
  io::write_report(options.report, "vam-photodiode", report);
}

}  // namespace

void add_photodiode(cli::App& app) {
  app.subcommand<PhotodiodeOptions>("photodiode", "intensity by grey level, from readings of a photodiode", declare,
                                    run);
}

}  // namespace vam::calibrate_tool
