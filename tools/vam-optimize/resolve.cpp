// SPDX-License-Identifier: GPL-3.0-or-later
// Resolves the options of vam-optimize: defaults, and values that follow from others.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/recorded_tolerances.hpp"
#include "io/stream/stream.hpp"
#include "optimize/methods/automatic.hpp"
#include "optimize/run/slice_figures.hpp"
#include "plot/save.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

namespace {

/// auto is the best method, stopped when the part prints with a margin unless the user sets a stopping criterion; the
/// shortest print is always one that meets a goal.
void resolve_auto(const cli::App& app, Options& options) {
  if (options.method != "auto") return;
  options.method = optimize::automatic_method;
  if (!options.until.empty() || !options.robust.empty() || (app.given("--iterations") && !options.shortest)) return;
  options.limits.at_least = optimize::automatic_iterations;
  options.until = options.demands.grey ? "ver=0"
                  : options.shortest   ? optimize::shortest_until
                                       : optimize::automatic_until;
  if (!options.demands.grey && !options.shortest) options.limits.least_rate = optimize::automatic_rate;
}

/// Parses --robust; its clause `calibration` means the records.
model::Tolerances named_tolerances(Options& options) {
  std::vector<std::string> clauses;
  for (const std::string& clause : split(options.robust, ',')) {
    if (trimmed(clause) == "calibration") {
      options.recorded_tolerances = true;
    } else {
      clauses.push_back(clause);
    }
  }
  if (clauses.empty() && options.recorded_tolerances) return {};
  return model::parse_tolerances(join(clauses, ","));
}

/// Tolerances are met by iterations that nothing but --until and --patience stops, if given.
void resolve_tolerances(const cli::App& app, Options& options) {
  if (options.robust.empty()) return;
  try {
    options.printer_tolerances = named_tolerances(options);
  } catch (const Error& error) {
    throw Error{error.fault, std::string("--robust: ") + error.what()};
  }
  if (!app.given("--patience")) options.limits.patience = 0;
}

/// The front is that of rising limits, whatever the print is at each.
void resolve_tradeoff(Options& options) {
  if (plot::is_figure(options.tradeoff)) plot::require_figures();
  options.until.clear();
  options.raising = optimize::front_raising;
  options.limit.of_even = optimize::shortest_of_even;
  options.limits.iterations = optimize::front_iterations;
  options.limits.patience = 0;
}

/// Without a limit of the user's a low one is raised until the part prints.
void resolve_raising(const cli::App& app, Options& options) {
  if (options.shortest && options.until.empty()) options.until = optimize::shortest_until;
  if (options.limit.of_even <= 0 || (!options.robust.empty() && options.until.empty())) return;
  options.raising = options.shortest ? optimize::shortest_raising : optimize::usual_raising;
  if (app.given("--until")) options.raising.enough = std::numeric_limits<double>::infinity();
  if (!options.shortest) return;
  options.limit.of_even = optimize::shortest_of_even;
  if (!app.given("--iterations")) options.limits.iterations = 4 * options.limits.iterations;
}

/// Duration of what follows the last iteration, in iterations: scaling, counting and writing; judging the frames as
/// they are shown and on other printers; the proof.
double rest_iterations(const Options& options) {
  double rest = 3;
  if (options.bits) rest += 3;
  if (!options.robust.empty()) rest += 5 + options.yield_printers / 3.0;
  if (!options.certify.empty()) rest += 1.2 * optimize::certify_iterations;
  return rest;
}

/// The clock of --budget begins now.
optimize::Deadline deadline_of(const Options& options) {
  using Clock = std::chrono::steady_clock;
  const auto now_s = [began = Clock::now()] { return std::chrono::duration<double>(Clock::now() - began).count(); };
  return {now_s, *options.budget_s, rest_iterations(options)};
}

void resolve_limit(Options& options, const optimize::MethodEntry& method) {
  const bool reads = optimize::reads(method, "--max-intensity");
  if (options.turns) return;  // with the printer
  if (options.max_intensity) {
    options.limit.most = *options.max_intensity;
  } else if (reads && !options.demands.grey) {
    options.limit.of_even = optimize::usual_of_even;
  }
}

}  // namespace

void resolve(const cli::App& app, const model::Printer& printer, Options& options) {
  static_cast<model::OptimizeSettings&>(options) = printer.optimize;
  if (options.in_vial() || !options.certify.empty()) options.line_integrals = "footprints";  // which prove bounds, too
  if (options.in_vial() && options.absorption_model == "disc") options.absorption_model = "exact";
  resolve_auto(app, options);
  const optimize::MethodEntry& method = optimize::method_entry(options.method);
  optimize::check(options.demands);
  if (!options.slices.empty()) (void)model::slices_named(options.slices);
  resolve_tolerances(app, options);
  if (options.demands.grey && !app.given("--resin-response")) options.response = "linear";
  options.demands.void_below = options.void_rule == "below";
  if (options.demands.grey && options.response != "step" && options.response != "logistic") {
    app.require_for(grey_part, io::input_name(options.input));
    if (!options.demands.void_below) app.require_for(grey_void, io::input_name(options.input));
  }
  options.demands.surface = options.surface == "voxels";
  options.demands.free_surface = options.surface == "free" || !optimize::reads(method, "optimize.surface");
  options.how.offset = options.negative == "offset";
  options.how.void_dose = options.void_dose;
  options.how.min_intensity = options.min_intensity;
  options.how.power = options.power;
  resolve_limit(options, method);
  options.limits.iterations = options.iterations.value_or(method.iterations);
  if (options.iterations && !app.given("--patience")) options.limits.patience = *options.iterations;  // all are done
  if (options.budget_s) options.limits.deadline = deadline_of(options);
  options.tradeoff.empty() ? resolve_raising(app, options) : resolve_tradeoff(options);
  if (!options.until.empty()) {
    options.limits.until = model::parse_conditions(options.until, optimize::SliceFigures::names());
  }
}

void resolve_recorded(const model::Printer& printer, Options& options) {
  if (!options.recorded_tolerances) return;
  model::Tolerances& all = *options.printer_tolerances;
  try {
    const model::Tolerances recorded = io::recorded_tolerances(printer);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = all[i] > 0 ? all[i] : recorded[i];
  } catch (const Error& error) {
    throw Error{error.fault, std::string("--robust: ") + error.what()};
  }
  const std::vector<std::string> exact = model::exact_quantities(all);
  note("vam-optimize: tolerances: " + model::tolerances_text(all) +
       (exact.empty() ? "" : "; neither recorded nor named: " + join(exact, ", ")));
}

namespace {

optimize::CureCurve read_curve(const std::string& path) {
  const io::CsvTable table = io::read_csv(path, {"dose", "response"});
  std::vector<std::pair<double, double>> points;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    points.emplace_back(table.number(row, 0), table.number(row, 1));
  }
  try {
    return optimize::CureCurve::table(points);
  } catch (const Error& error) {
    throw Error{error.fault, path + ": " + error.what()};
  }
}

/// LOW and HIGH are the doses whose responses differ from liquid and cured by the band.
void resolve_window(const cli::App& app, const std::string& path, optimize::Demands& demands) {
  const auto band = static_cast<float>(demands.band);
  const double low = static_cast<double>(demands.curve.doses(0, band).high);
  const double high = static_cast<double>(demands.curve.doses(1, band).low);
  if (!std::isfinite(low) || !std::isfinite(high)) {
    throw Error{Fault::data, path + ": the response must reach from " + format_number(demands.band) + " to " +
                                 format_number(1 - demands.band) + " (--band); measure more doses or change --band"};
  }
  if (!app.given("--dose-low")) demands.window.low = low;
  if (!app.given("--dose-high")) demands.window.high = high;
  optimize::check(demands);
}

}  // namespace

void resolve_angles(const cli::App& app, Options& options) {
  if (app.given("--angles") || options.init.empty() || options.init == "-") return;
  const double step_deg = std::abs(io::StackReader(options.init).info().angle_step_deg);
  if (step_deg > 0) options.angles = round_int(360 / step_deg);
}

void resolve_response(const cli::App& app, Options& options) {
  optimize::Demands& demands = options.demands;
  const optimize::DoseWindow& window = demands.window;
  if (options.response == "linear") {
    demands.curve = optimize::CureCurve::linear();
  } else if (options.response == "step") {
    demands.curve = optimize::CureCurve::step(window.low, window.high);
  } else if (options.response == "logistic") {
    demands.curve = optimize::CureCurve::logistic(
        window.threshold(), options.softness.value_or(optimize::method_entry(options.method).softness));
  } else {
    const std::vector<std::string> names{"linear", "step", "logistic"};
    if (options.response != "-" && !std::filesystem::exists(options.response)) {
      throw Error{Fault::no_input, "--resin-response: '" + options.response + "' is none of " + join(names, ", ") +
                                       " and no file" + did_you_mean(options.response, names)};
    }
    demands.curve = read_curve(options.response);
    if (!demands.grey) resolve_window(app, options.response, demands);
  }
}

}  // namespace vam::optimize_tool
