// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate photodiode, uniformity: the projector's grey response and flat field from readings of a photodiode.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/image.hpp"
#include "base/log/log.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "cli/common.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "model/rows.hpp"
#include "plot/plot.hpp"
#include "plot/save.hpp"
#include "resin/response.hpp"
#include "resin/response_fit.hpp"
#include "session/printer.hpp"
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

void add_dark(cli::App& app, double& reading) {
  app.option("--dark-reading", "READING", reading, cli::any,
             "Reading of the photodiode without light; it is subtracted.");
}

void declare(cli::App& app, PhotodiodeOptions& options) {
  app.positional("DATA", options.input, "CSV with the columns grey,reading; one line per measurement.").reads();
  cli::add_output(app, options.output);
  add_dark(app, options.dark);
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

struct UniformityOptions {
  std::string input = "-", output = "-";
  double dark = 0;
  cli::PrinterOptions printer;
};

void declare_places(cli::App& app, UniformityOptions& options) {
  app.positional("DATA", options.input,
                 "CSV with the columns column,row,reading: projector pixels before orientation, all of one grey level; "
                 "9 places or more, over the whole image.")
      .reads();
  cli::add_output(app, options.output).writes_as({".exr", ".toml"});
  add_dark(app, options.dark);
  cli::add_printer(app, options.printer);
}

/// Powers of the place in the image, which is -1 ... 1 in both directions, up to that degree.
std::vector<double> terms_of(const model::Projector& projector, int degree, double column, double row) {
  const double x = 2 * (column + 0.5) / projector.columns - 1, y = 2 * (row + 0.5) / projector.rows - 1;
  std::vector<double> terms;
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; i + j <= degree; ++j) terms.push_back(std::pow(x, i) * std::pow(y, j));
  }
  return terms;
}

/// Readings above the dark and their places. Throws Fault::data for places beside the image, readings without light,
/// and fewer than 9 or in a part of the image only.
void read_places(const io::CsvTable& csv, double dark, const model::Projector& projector, int degree,
                 std::vector<double>& rows, std::vector<double>& readings) {
  double least[2] = {1, 1}, most[2] = {-1, -1};
  for (std::size_t i = 0; i < csv.rows.size(); ++i) {
    const std::vector<double> terms = terms_of(projector, degree, csv.number(i, 0), csv.number(i, 1));
    const double reading = csv.number(i, 2) - dark, at[2] = {terms[degree + 1], terms[1]};
    if (!(std::max(std::abs(at[0]), std::abs(at[1])) <= 1 && reading > 0)) {
      throw Error{Fault::data, csv.source + ": reading " + std::to_string(i + 1) + ", of column " +
                                   format_number(csv.number(i, 0)) + " and row " + format_number(csv.number(i, 1)) +
                                   ", is " + format_number(reading) +
                                   " above the dark; it must be in the image, and lit"};
    }
    for (int d = 0; d < 2; ++d) {
      least[d] = std::min(least[d], at[d]);
      most[d] = std::max(most[d], at[d]);
    }
    rows.insert(rows.end(), terms.begin(), terms.end());
    readings.push_back(reading);
  }
  if (readings.size() >= 9 && most[0] - least[0] >= 2 * 0.7 && most[1] - least[1] >= 2 * 0.7) return;
  throw Error{Fault::data, csv.source + ": " + std::to_string(readings.size()) +
                               " readings; at least 9 are needed, over 0.7 of the columns and of the rows"};
}

/// The smooth field through the readings, of every pixel, the largest 1. Throws as read_places(), and Fault::data where
/// they are off it.
Image field_of(const io::CsvTable& csv, double dark, const model::Projector& projector) {
  const int degree = csv.rows.size() < 25 ? 2 : 4;  // 6 terms, or 15
  std::vector<double> rows, readings;
  read_places(csv, dark, projector, degree, rows, readings);
  const std::size_t count = terms_of(projector, degree, 0, 0).size();
  const auto residuals = [&](const std::vector<double>& parts) {
    std::vector<double> off = stats::sums_of(rows, parts);
    for (std::size_t i = 0; i < off.size(); ++i) off[i] = readings[i] - off[i];
    return off;
  };
  const auto n = static_cast<double>(readings.size());
  const double mean = std::accumulate(readings.begin(), readings.end(), 0.0) / n;
  const auto fit = stats::fit_curve(residuals, std::vector<double>(count, 0.0), std::vector<double>(count, mean),
                                    csv.source + ": places of the readings");  // a row of them fits any field
  const double rms = fit.rms / mean * std::sqrt(n / (n - static_cast<double>(count)));
  if (!(rms <= 0.02)) {
    throw Error{Fault::data, csv.source + ": its readings are " + format_number(100 * rms, 2) +
                                 " % (RMS) off a smooth field, more than 2 %; measure again, or more places"};
  }
  Image flat(projector.columns, projector.rows);
  for (int y = 0; y < flat.height; ++y) {
    for (int x = 0; x < flat.width; ++x)
      flat(x, y) = static_cast<float>(stats::sums_of(terms_of(projector, degree, x, y), fit.value).front());
  }
  const float most = *std::max_element(flat.values.begin(), flat.values.end());
  for (float& value : flat.values) value /= most;
  return flat;
}

void run_uniformity(const cli::App& app, UniformityOptions& options) {
  const model::Printer printer = session::load_printer(options.printer);
  if (session::print_printer(options.printer, printer, options.output)) return;
  const Image flat =
      field_of(io::read_csv(options.input, {"column", "row", "reading"}), options.dark, printer.projector);
  model::StackInfo info;
  info.kind = model::Kind::frames;
  info.space = model::Space::projector;
  info.width = flat.width;
  info.height = flat.height;
  info.count = 1;
  info.pixel_mm = printer.projector.pixel_mm;
  info.row_mm = -info.pixel_mm;
  info.z_start_mm = model::z_mm(printer.projector, 0);
  info.units = "fraction of the brightest pixel";
  info.history.push_back(app.history());
  io::StackWriter writer(options.output, info);
  writer.write(flat);
  writer.commit();
  note("vam-calibrate: the darkest pixel has " +
       format_number(*std::min_element(flat.values.begin(), flat.values.end()), 3) +
       " of the brightest; with projector.flat, projector.max_intensity_mw_cm2 is that of the darkest");
}

}  // namespace

void add_photodiode(cli::App& app) {
  app.subcommand<PhotodiodeOptions>("photodiode", "intensity by grey level, from readings of a photodiode", declare,
                                    run);
  app.subcommand<UniformityOptions>(
      "uniformity", "the projector's flat field, from readings of a photodiode at places of an even image",
      declare_places, run_uniformity);
}

}  // namespace vam::calibrate_tool
