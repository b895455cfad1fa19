// vam-score: scores a dose against its target.
#include <algorithm>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/log.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/report.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"
#include "model/conditions.hpp"
#include "model/dose_metrics.hpp"
#include "model/grid_size.hpp"
#include "optics/writable.hpp"
#include "printer.hpp"
#include "score/score.hpp"
#include "vam-score/inputs.hpp"
#include "vam-score/options.hpp"
#include "vam-score/print.hpp"
#include "vam-score/reach.hpp"

namespace {

using namespace vam;
using score_tool::Inputs;
using score_tool::Options;

score::Score score(const Inputs& in, const score::ScoreOptions& how) {
  constexpr int slab = 16;
  const model::Grid& grid = in.target().grid();
  require_memory(2.0 * sizeof(float) * slab * static_cast<double>(grid.slice_size()),
                 in.target().name() + ": " + model::size_text(grid), "use larger voxels");
  score::Score result(how, grid.nx, grid.ny);
  std::vector<float> dose(grid.slice_size() * slab);
  std::vector<float> target(grid.slice_size() * slab);
  Progress progress("scoring", grid.nz);
  for (int k = 0; k < grid.nz; k += slab) {
    const int count = std::min(slab, grid.nz - k);
    in.dose().read_slices(k, count, dose.data());
    in.target().read_slices(k, count, target.data());
    result.add(dose.data(), target.data(), count);
    progress.tick(count);
  }
  return result;
}

/// A dose in mJ/cm3 has a critical dose and a duration of the print.
void settle_exposure(score::ScoreOptions& how, const Inputs& in, const model::Printer& printer) {
  const double farthest_mm = io::farthest_mm(in.target(), model::coverage_rounding);
  how.circle = model::writable_circle(in.target().grid(), optics::judged_radius_mm(printer, farthest_mm));
  const auto made_for = in.dose().metadata.find("vam:threshold_dose");
  if (made_for != in.dose().metadata.end()) how.aimed_at = parse_number(made_for->second);
  if (in.dose().units != "mJ/cm3" || !printer.resin.critical_dose_mj_cm3) return;
  if (!how.threshold) how.threshold = printer.resin.critical_dose_mj_cm3;
  const auto turns = in.dose().metadata.find("vam:full_light_turns");  // of vam-dose --exposure-plan
  how.exposure = {printer, turns == in.dose().metadata.end() ? 1.0 : std::stod(turns->second)};
}

void add_light(score::Score& result, const std::string& sinogram) {
  io::StackReader light(sinogram);
  Image image;
  for (model::ImageInfo about; light.next(image, about);) result.add_projection(image.values);
}

void require_files_for_outputs(const Options& options) {
  for (const auto& output : {options.print, options.report, options.reach}) {
    if (output != "-") continue;
    throw Error{Fault::usage,
                "--mesh, --reach, --report: standard output holds the figures of merit; name a file instead of -"};
  }
}

void run(const cli::App& app, Options& options) {
  std::vector<model::Condition> conditions;
  if (!options.require.empty()) conditions = model::parse_conditions(options.require, score::Score::names());
  const model::Printer printer = tool::load_printer(options.printer);
  if (tool::print_printer(options.printer, printer, "-")) return;
  require_files_for_outputs(options);
  const Inputs in = read(options);
  settle_exposure(options.how, in, printer);
  score::Score result = score(in, options.how);
  if (!options.sinogram.empty()) add_light(result, options.sinogram);
  const Json figures = result.figures();
  if (!options.reach.empty()) score_tool::write_reach(options.reach, in.target().grid(), printer, app);
  if (!options.print.empty()) write_print(options, in.dose(), options.print_at.value_or(result.print_threshold()));
  io::write_report(options.report, "vam-score/1", figures);
  io::write_text("-", options.json ? figures.dump(2) + "\n" : result.table());
  const auto failures = model::unmet(conditions, [&](const std::string& name) { return result.figure(name); });
  if (!failures.empty()) throw Error{Fault::judged, join(failures, "; ")};
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(score_tool::manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
