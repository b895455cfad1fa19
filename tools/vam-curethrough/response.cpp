// SPDX-License-Identifier: GPL-3.0-or-later
// The projector's grey response from photodiode readings.
#include <cmath>

#include "base/json.hpp"
#include "base/text.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/report.hpp"
#include "io/stream/stream.hpp"
#include "resin/response_fit.hpp"
#include "vam-curethrough/figures.hpp"
#include "vam-curethrough/subcommands.hpp"

namespace vam::curethrough {

void declare(cli::App& app, GreyResponseOptions& options) {
  app.positional("DATA", options.input, "CSV with the columns grey,reading; one line per measurement.").reads();
  cli::add_output(app, options.output);
  app.option("--dark-reading", "READING", options.dark, cli::any,
             "Reading of the photodiode without light; it is subtracted.");
  app.option("--irradiance-per-reading", "MW_CM2", options.scale, cli::positive, "Irradiance per unit of reading.");
  app.option("--plot", "FILE", options.plot, "Plot the mean readings and the response curve (.png, .pdf or .svg).")
      .writes();
  cli::add_report(app, options.report);
}

void run(const cli::App& root, const cli::App&, const GreyResponseOptions& options) {
  const io::CsvTable csv = io::read_csv(options.input, {"grey", "reading"});
  std::vector<resin::PhotodiodeReading> readings;
  for (std::size_t row = 0; row < csv.rows.size(); ++row) readings.push_back({csv.number(row, 0), csv.number(row, 1)});
  resin::ResponseFit fit = resin::fit_response(readings, options.dark, csv.source);
  std::string text = "# " + root.history() + "\ngrey,intensity\n";
  for (std::size_t i = 0; i < fit.table.grey.size(); ++i) {
    fit.table.intensity[i] *= options.scale;
    text += format_number(fit.table.grey[i], 9) + "," + format_number(fit.table.intensity[i], 9) + "\n";
  }
  io::write_text(options.output, text);
  if (!options.plot.empty()) draw_response(options.plot, fit.table);
  Json report{{"levels", fit.table.grey.size()},
              {"readings", readings.size()},
              {"contrast", nullptr},
              {"gamma", fit.gamma},
              {"noise", fit.noise},
              {"pooled_levels", fit.pooled},
              {"min_intensity", fit.table.intensity.front()},
              {"max_intensity", fit.table.intensity.back()}};
  if (std::isfinite(fit.contrast)) report["contrast"] = fit.contrast;
  io::write_report(options.report, "vam-curethrough-response", report);
}

}  // namespace vam::curethrough
