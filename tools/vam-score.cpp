// SPDX-License-Identifier: GPL-3.0-or-later
// vam-score: scores a dose against its target.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "model/conditions.hpp"
#include "model/metadata.hpp"
#include "score/score.hpp"
#include "session/dose_score.hpp"
#include "session/exposure.hpp"
#include "session/grey_target.hpp"
#include "session/printer.hpp"
#include "session/volumes.hpp"
#include "vam-score/options.hpp"
#include "vam-score/outputs.hpp"

namespace {

using namespace vam;
using score_tool::Options;

void add_light(score::Score& result, const std::string& sinogram) {
  io::StackReader light(sinogram);
  Image image;
  for (model::ImageInfo about; light.next(image, about);) result.add_projection(image.values);
}

/// Conditions must be on figures that the inputs determine.
void require_known(const std::vector<model::Condition>& conditions, const Options& options) {
  const score::ScoreOptions& how = options.how;
  for (const model::Condition& condition : conditions) {
    const std::string subject = "--require " + condition.name + ": ";
    if (condition.name.starts_with("cured_") && !how.threshold && !how.exposure) {
      throw Error{Fault::usage, subject +
                                    "the critical dose is not known; give --critical-dose, or set "
                                    "resin.critical_dose_mj_cm3 and score a dose in mJ/cm3"};
    }
    if (score::is_of_exposure(condition.name) && !how.exposure) {
      throw Error{Fault::usage,
                  subject + "the exposure is not known; set resin.critical_dose_mj_cm3 and score a dose in mJ/cm3"};
    }
    if (condition.name == "efficiency" && options.sinogram.empty()) {
      throw Error{Fault::usage, subject + "requires the projections; give --sinogram"};
    }
  }
}

void require_files_for_outputs(const Options& options) {
  for (const auto& output : {options.print, options.lit_fraction}) {
    if (output != "-") continue;
    throw Error{Fault::usage,
                "--mesh, --lit-fraction: standard output holds the figures of merit; give a file instead of -"};
  }
}

std::vector<model::Condition> conditions_of(const Options& options) {
  if (options.require.empty()) return {};
  return model::parse_conditions(options.require,
                                 options.grey.is_target ? score::GreyScore::names() : score::Score::names());
}

void score_grey(const Options& options, const std::vector<model::Condition>& conditions) {
  const std::string& input = options.inputs.front();
  session::Companions in(input, options.target, io::TargetKind::grey);
  const io::SparseVolume& dose = in.choose(options.grid);
  const model::Printer printer = session::printer_of(options.printer, dose.metadata, io::input_name(input));
  const score::GreyScore result =
      session::score_grey(dose, in.target_around(), options.grey, in.tolerance(), printer, input);
  io::write_report(options.report, "vam-score-grey", result.figures());
  if (options.report != "-") io::write_text("-", result.table());
  model::require_met(conditions, [&](const std::string& name) { return result.figure(name); });
}

/// A dose on its target, in its printer.
struct Judged {
  session::Companions in;
  const io::SparseVolume& dose;
  const io::SparseVolume& target;
  model::Printer printer;
  score::Score result;
};
Judged judged(Options options, const std::string& input, const std::vector<model::Condition>& conditions) {
  session::Companions in(input, options.target, io::TargetKind::coverage);
  const io::SparseVolume& dose = in.choose(options.grid);
  const io::SparseVolume& target = in.target_around();
  const model::Printer printer = session::printer_of(options.printer, dose.metadata, io::input_name(input));
  session::warn_of_grey(target, in.file());
  options.how.target = io::input_name(in.file());
  session::resolve_exposure(options.how, dose, target, printer);
  require_known(conditions, options);
  score::Score result = session::score_print(dose, target, options.how);
  if (!options.sinogram.empty()) add_light(result, options.sinogram);
  return {std::move(in), dose, target, printer, std::move(result)};
}

void meet(const std::vector<model::Condition>& conditions, const score::Score& result) {
  model::require_met(conditions, [&](const std::string& name) { return result.figure(name); });
}

void tabulate(const Options& options, const std::vector<model::Condition>& conditions) {
  std::vector<score::Score> results;
  for (const std::string& input : options.inputs) results.push_back(judged(options, input, conditions).result);
  score_tool::Table table{{"figure"}};
  for (const std::string& input : options.inputs) table.front().push_back(io::input_name(input));
  for (const std::string& name : score::Score::names()) {
    std::vector<std::string>& row = table.emplace_back(1, name);
    for (const score::Score& result : results) {
      const double value = result.figure(name);
      row.push_back(std::isnan(value) ? "" : format_number(value, 6));
    }
    if (std::all_of(row.begin() + 1, row.end(), [](const auto& cell) { return cell.empty(); })) table.pop_back();
  }
  io::write_text("-", score_tool::text_of(table, options.table));
  for (const score::Score& result : results) meet(conditions, result);
}

void run(const cli::App& app, Options& options) {
  const std::vector<model::Condition> conditions = conditions_of(options);
  if (session::print_printer(options.printer)) return;
  if (options.table != "text") return tabulate(options, conditions);
  if (options.inputs.size() > 1) {
    throw Error{Fault::usage, std::to_string(options.inputs.size()) +
                                  " doses: one is scored at a time; give --table csv, markdown or latex for several"};
  }
  if (options.grey.is_target) return score_grey(options, conditions);
  require_files_for_outputs(options);
  const Judged judge = judged(options, options.inputs.front(), conditions);
  const score::Score& result = judge.result;
  const Json figures = result.figures();
  if (!options.lit_fraction.empty())
    score_tool::write_lit_fraction(options.lit_fraction, judge.target.grid(), judge.printer, app);
  if (!options.print.empty()) write_print(options, judge.dose, options.print_at.value_or(result.print_threshold()));
  io::write_report(options.report, "vam-score", figures);
  if (options.report != "-") {
    const std::string sinogram = options.sinogram.empty() ? "SINOGRAM" : options.sinogram;
    const bool stated = model::stated_text(judge.dose.metadata, "vam:dose_of") == "stated";
    const std::string how = session::how_to_show(judge.printer.resin, stated, sinogram, options.printer);
    io::write_text("-", result.table(options.grid == "dose" ? how : ""));
  }
  meet(conditions, result);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app({"vam-score", "score a dose against its target", manual_page});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
