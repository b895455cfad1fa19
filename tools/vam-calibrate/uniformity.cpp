// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate uniformity: the projector's flat field from readings of a photodiode at places of an even image.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/image.hpp"
#include "base/log/log.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/text/text.hpp"
#include "cli/common.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/csv_table.hpp"
#include "model/rows.hpp"
#include "session/printer.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

struct UniformityOptions {
  std::string input = "-", output = "-";
  double dark = 0;
  cli::PrinterOptions printer;
};

void declare(cli::App& app, UniformityOptions& options) {
  app.positional("DATA", options.input,
                 "CSV with the columns column,row,reading: projector pixels before orientation, all of one grey level; "
                 "9 places or more, over the whole image.")
      .reads();
  cli::add_output(app, options.output);
  app.option("--dark-reading", "READING", options.dark, cli::any,
             "Reading of the photodiode without light; it is subtracted.");
  cli::add_printer(app, options.printer);
}

/// A polynomial of the place in the image, which is -1 ... 1 in both directions.
class Field {
 public:
  /// Throws Fault::data for places beside the image, readings without light, and too few of either.
  Field(const io::CsvTable& csv, double dark, const model::Projector& projector) : projector_(projector) {
    constexpr std::size_t fewest = 9, many = 25;  // for the 6 terms of degree 2, the 15 of degree 4
    degree_ = csv.rows.size() < many ? 2 : 4;
    double least[2] = {1, 1}, most[2] = {-1, -1};
    for (std::size_t i = 0; i < csv.rows.size(); ++i) {
      const double column = csv.number(i, 0), row = csv.number(i, 1), reading = csv.number(i, 2) - dark;
      const double at[2] = {x(column), y(row)};
      if (!(std::max(std::abs(at[0]), std::abs(at[1])) <= 1 && reading > 0)) {
        throw Error{Fault::data, csv.source + ": reading " + std::to_string(i + 1) + ", of column " +
                                     format_number(column) + " and row " + format_number(row) + ", is " +
                                     format_number(reading) + " above the dark; it must be in the image, and lit"};
      }
      for (int d = 0; d < 2; ++d) {
        least[d] = std::min(least[d], at[d]);
        most[d] = std::max(most[d], at[d]);
      }
      const std::vector<double> terms = terms_at(column, row);
      rows_.insert(rows_.end(), terms.begin(), terms.end());
      readings_.push_back(reading);
    }
    constexpr double span = 1.4;  // of 2
    if (readings_.size() < fewest || most[0] - least[0] < span || most[1] - least[1] < span) {
      throw Error{Fault::data, csv.source + ": " + std::to_string(readings_.size()) +
                                   " readings; at least 9 are needed, over 0.7 of the columns and of the rows"};
    }
    parts_ = stats::linear_fit(rows_, terms_at(0, 0).size(), readings_);
  }

  /// Of the readings about it, over their mean.
  [[nodiscard]] double rms() const {
    const std::vector<double> fitted = stats::sums_of(rows_, parts_);
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      squares += (fitted[i] - readings_[i]) * (fitted[i] - readings_[i]);
      sum += readings_[i];
    }
    const auto n = static_cast<double>(fitted.size());
    return std::sqrt(squares / (n - static_cast<double>(parts_.size()))) / (sum / n);
  }

  /// The largest value 1.
  [[nodiscard]] Image image() const {
    Image flat(projector_.columns, projector_.rows);
    for (int row = 0; row < flat.height; ++row) {
      for (int column = 0; column < flat.width; ++column)
        flat(column, row) = static_cast<float>(stats::sums_of(terms_at(column, row), parts_).front());
    }
    const float most = *std::max_element(flat.values.begin(), flat.values.end());
    for (float& value : flat.values) value /= most;
    return flat;
  }

 private:
  [[nodiscard]] double x(double column) const { return 2 * (column + 0.5) / projector_.columns - 1; }
  [[nodiscard]] double y(double row) const { return 2 * (row + 0.5) / projector_.rows - 1; }
  [[nodiscard]] std::vector<double> terms_at(double column, double row) const {
    std::vector<double> terms;
    for (int i = 0; i <= degree_; ++i) {
      for (int j = 0; i + j <= degree_; ++j) terms.push_back(std::pow(x(column), i) * std::pow(y(row), j));
    }
    return terms;
  }

  model::Projector projector_;
  int degree_ = 2;
  std::vector<double> rows_, readings_, parts_;
};

void write(const std::string& path, const Image& flat, const model::Projector& projector, const cli::App& app) {
  model::StackInfo info;
  info.kind = model::Kind::frames;
  info.space = model::Space::projector;
  info.width = flat.width;
  info.height = flat.height;
  info.count = 1;
  info.pixel_mm = projector.pixel_mm;
  info.row_mm = -projector.pixel_mm;
  info.z_start_mm = model::z_mm(projector, 0);
  info.units = "fraction of the brightest pixel";
  info.history.push_back(app.history());
  io::StackWriter writer(path, info);
  writer.write(flat);
  writer.commit();
}

void run(const cli::App& app, UniformityOptions& options) {
  const model::Printer printer = session::load_printer(options.printer);
  if (session::print_printer(options.printer, printer, options.output)) return;
  const io::CsvTable csv = io::read_csv(options.input, {"column", "row", "reading"});
  const Field field(csv, options.dark, printer.projector);
  constexpr double most_rms = 0.02;
  if (const double rms = field.rms(); !(rms <= most_rms)) {
    throw Error{Fault::data, csv.source + ": its readings are " + format_number(100 * rms, 2) +
                                 " % (RMS) off a smooth field, more than 2 %; measure again, or more places"};
  }
  const Image flat = field.image();
  write(options.output, flat, printer.projector, app);
  note("vam-calibrate: the darkest pixel has " +
       format_number(*std::min_element(flat.values.begin(), flat.values.end()), 3) +
       " of the brightest; with projector.flat, projector.max_intensity_mw_cm2 is that of the darkest");
}

}  // namespace

void add_uniformity(cli::App& app) {
  app.subcommand<UniformityOptions>(
      "uniformity", "the projector's flat field, from readings of a photodiode at places of an even image", declare,
      run);
}

}  // namespace vam::calibrate_tool
