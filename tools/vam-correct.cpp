// SPDX-License-Identifier: GPL-3.0-or-later
// vam-correct: where a print cures ahead of its dose or behind it, and the dose that the light for the rest starts
// from.
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/vdb/vdb.hpp"
#include "manual_page.hpp"
#include "metrology/cure/sensitivity.hpp"
#include "model/metadata.hpp"
#include "session/volumes.hpp"
#include "vam-correct/renewal.hpp"

namespace {

using namespace vam;

struct Options {
  std::string scatter;
  std::string curve;
  std::vector<std::string> acted, delivered;
  std::string uncertainty;
  std::string before;
  std::optional<double> column_offset_px;
  double axis_px = 0;
  double axis_sigma_px = 1;
  std::optional<double> resolution_mm;
  metrology::CorrectionLimits limits;
  double max_uncertainty_percent = 3;
  double max_factor = 1.6;
  std::string output = "-";
  std::string field;
  std::string report;
};

void declare(cli::App& app, Options& o) {
  app.positional("SCATTER", o.scatter, "Volume 'scatter' (VDB) of vam-ost --live.").reads();
  cli::add_output(app, o.output).writes_as({".vdb"});
  app.option("--curve", "RECORD", o.curve, "Record of vam-calibrate working-curve of this resin.").reads().required();
  app.option(
         "--acted", "FILE.vdb", o.acted,
         "Dose that had acted in the middle of the turn of views: vam-dose --shown --before, earlier by the delay of "
         "the record.")
      .required();
  app.option("--dose", "FILE.vdb", o.delivered,
             "Dose that will have been delivered when light for the rest begins, likewise.");
  app.default_is("--acted");
  app.option("--uncertainty", "FILE.vdb", o.uncertainty, "Standard deviations of SCATTER (vam-ost --uncertainties).")
      .reads();
  app.option("--column-offset", "PX", o.column_offset_px, cli::positive,
             "Find the axis, too: each dose is given three times, by vam-dose with --column-offset AXIS - PX, AXIS and "
             "AXIS + PX.");
  app.option("--axis", "PX", o.axis_px, cli::any, "AXIS of these, where the axis is about.")
      .only_with({"--column-offset"});
  app.option("--axis-sigma", "PX", o.axis_sigma_px, cli::positive,
             "Standard deviation of projector.axis_column, as its calibration states it.")
      .only_with({"--column-offset"});
  app.option("--before", "REPORT", o.before, "Report of vam-correct of the turn before.").reads();
  app.option("--resolution", "MM", o.resolution_mm, cli::non_negative,
             "Standard deviation of what blurs the densities.");
  app.default_is("0.7 voxels of SCATTER");
  app.option("--max-uncertainty", "PERCENT", o.max_uncertainty_percent, cli::positive,
             "Maximum uncertainty of the sensitivity (one standard deviation) anywhere in the part.");
  app.option("--max-factor", "FACTOR", o.max_factor, {1, 100, true}, "Maximum sensitivity, and one over the minimum.");
  app.option("--sensitivity", "FILE.vdb", o.field, "Write the volume 'sensitivity'.").writes({".vdb"});
  cli::add_report(app, o.report);
  cli::add_threads(app);
  app.usual({"--output", "--dose", "--uncertainty", "--column-offset", "--before", "--sensitivity", "--report"});
}

/// A dose for one place of the axis, or for three; and the first one's facts.
struct Dose {
  metrology::PlannedDose planned;
  io::SparseVolume first;
};

Dose read_doses(const std::vector<std::string>& paths, const Options& options, const char* flag) {
  const std::size_t wanted = options.column_offset_px ? 3 : 1;
  if (paths.size() != wanted) {
    throw Error{Fault::usage, std::string(flag) + ": " + std::to_string(paths.size()) +
                                  (paths.size() == 1 ? " file" : " files") +
                                  (wanted == 3 ? ", not the three that --column-offset requires"
                                               : ", not one; three require --column-offset")};
  }
  io::SparseVolume first = session::read_dose(paths.front());
  metrology::PlannedDose planned{{io::dense_volume(first)}, options.column_offset_px.value_or(1), options.axis_px};
  for (std::size_t n = 1; n < paths.size(); ++n) {
    planned.at.push_back(io::dense_volume(session::read_dose(paths[n])));
    if (planned.at.back().grid == planned.at.front().grid) continue;
    throw Error{Fault::data,
                paths[n] + ": has other voxels than " + paths.front() + "; compute both by vam-dose --like"};
  }
  return {std::move(planned), std::move(first)};
}

/// What is made of a file's numbers, where the error does not know its name.
template <class Make>
auto of_file(const std::string& path, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error{error.fault, path + ": " + error.what()};
  }
}

metrology::ScatterCurve curve_of(const std::string& path) {
  const Json record = io::sealed_record(path, {"vam-working-curve"});
  return of_file(path, [&] { return metrology::scatter_curve(record); });
}

metrology::SensitivityField field_before(const Options& options, const model::Volume& dose,
                                         const metrology::ScatterCurve& curve) {
  metrology::SensitivityPrior prior;
  prior.axis_px = options.column_offset_px.value_or(0) > 0 ? options.axis_sigma_px : 0;
  if (options.before.empty()) {
    auto expected = metrology::expected_sensitivity(dose, curve, prior);
    expected.axis_px = options.axis_px;
    return expected;
  }
  const Json report = io::sealed_record(options.before, {"vam-correct"});
  return of_file(options.before, [&] {
    return carried_on(metrology::sensitivity_field(report.value("field", Json::object())), prior);
  });
}

void write(const cli::App& app, const std::string& path, const std::string& name, const std::string& units,
           const model::Volume& volume, const io::SparseVolume& like) {
  io::SparseVolume made(name, volume.grid);
  made.history = like.history;
  made.history.push_back(app.history());
  made.metadata = like.metadata;
  made.units = units;
  made.write_slices(0, volume.grid.nz, volume.values.data());
  io::write_volume(path, made);
}

model::Volume sensitivity(const metrology::SensitivityField& field, const model::Grid& g) {
  model::Volume volume{g, {}};
  for (int k = 0; k < g.nz; ++k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        volume.values.push_back(static_cast<float>(std::exp(field.log_at(g.x_mm(i), g.y_mm(j), g.z_mm(k)))));
      }
    }
  }
  return volume;
}

Json figures(const metrology::SensitivityFit& fit, const metrology::SensitivityRange& range,
             const std::vector<std::string>& doubts) {
  return {{"verdict", doubts.empty() ? "go" : "hold"},
          {"doubts", doubts},
          {"sensitivity_low", range.low},
          {"sensitivity_mean", range.mean},
          {"sensitivity_high", range.high},
          {"sensitivity_sigma", range.sigma},
          {"axis_offset_px", fit.field.axis_px},
          {"axis_offset_sigma_px", fit.field.axis_sigma_px()},
          {"rms_sigmas", fit.rms},
          {"residuals_of_before", fit.explained},
          {"voxels", fit.voxels},
          {"field", to_json(fit.field)}};
}

/// Scatter, doses and curve -> field -> dose to complete, or doubts.
void run(const cli::App& app, Options& options) {
  options.limits.sigma = 0.01 * options.max_uncertainty_percent;
  options.limits.deviation = std::log(options.max_factor);
  const metrology::ScatterCurve curve = curve_of(options.curve);
  const io::SparseVolume seen = session::read_scatter(options.scatter);
  const model::Volume scatter = io::dense_volume(seen);
  std::optional<model::Volume> sigma;
  if (!options.uncertainty.empty()) sigma = io::dense_volume(io::read_volume(options.uncertainty, "uncertainty"));
  if (sigma && sigma->grid != scatter.grid) {
    throw Error{Fault::data, options.uncertainty + ": has other voxels than " + options.scatter};
  }
  const Dose shown = read_doses(options.acted, options, "--acted");
  const Dose given = read_doses(options.delivered.empty() ? options.acted : options.delivered, options, "--dose");
  const metrology::ActedDose acted{shown.planned, model::stretch_z(shown.first.metadata)};
  const auto before = field_before(options, given.planned.middle(), curve);
  const auto fit = fit_sensitivity(scatter, sigma ? &*sigma : nullptr, acted, curve, before,
                                   options.resolution_mm.value_or(0.7 * scatter.grid.voxel_mm));
  const model::Volume delivered = given.planned.with(fit.field.axis_px);
  const auto range = range_of(fit.field, delivered, curve.critical_dose_mj_cm3);
  const auto range_before = range_of(before, delivered, curve.critical_dose_mj_cm3);
  const std::vector<std::string> against = doubts(fit, range, range_before, options.limits);
  io::write_report(options.report, "vam-correct", figures(fit, range, against));
  if (!options.field.empty()) {
    write(app, options.field, "sensitivity", "relative", sensitivity(fit.field, delivered.grid), given.first);
  }
  if (!against.empty()) throw Error{Fault::judged, options.scatter + ": " + join(against, "; ")};
  write(app, options.output, "dose", "mJ/cm3", delivered_dose(delivered, fit.field, curve.critical_dose_mj_cm3),
        given.first);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-correct",
                "measure where a print cures ahead of its dose or behind it, once a turn",
                manual_page,
                {{1, "There is doubt: no new light should be computed from this turn."},
                 {129, "renew: SIGHUP."},
                 {130, "renew: SIGINT."},
                 {143, "renew: SIGTERM."}}});
  Options options;
  declare(app, options);
  correct_tool::add_renew(app);
  return app.run(argc, argv, [&] { run(app, options); });
}
