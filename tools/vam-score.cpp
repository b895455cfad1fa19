// vam-score: is this dose printable?
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr_stack.hpp"
#include "io/mesh_file.hpp"
#include "io/report.hpp"
#include "io/stream.hpp"
#include "io/vdb.hpp"
#include "metrology/score.hpp"
#include "model/conditions.hpp"
#include "printer.hpp"
#include "solid/isosurface.hpp"

namespace {

using namespace vam;

struct Options {
  std::string input = "-";
  std::string grid = "dose";
  std::string target;
  std::string sinogram;
  std::string require;
  std::string report;
  std::string print;
  std::string print_as = "mesh";
  std::optional<double> print_at;
  bool json = false;
  metrology::ScoreOptions how;
  cli::PrinterOptions printer;
};

cli::Manual manual() {
  return {
      "vam-score",
      "judge a dose against its target",
      {"vam-score compares the dose in every voxel (VDB, as vam-dose writes it) with the target and prints the figures "
       "of merit of volumetric printing, one a line: name, value, meaning. G is the part, V the void inside the "
       "writable circle, f the dose: VER = #{V: f >= min_G f} / (#G + #V). PW, the process window, = min_G f - max_V "
       "f; where it is positive some threshold dose prints the part exactly. IPDR = max_G f - min_G f. CV = sigma_G / "
       "mean_G. IoU = |print and part| / |print or part| at the threshold where it is best.",
       "PW and IPDR are fractions of the largest dose, or in the dose's unit with --absolute. The trimmed figures take "
       "the ALPHA/2 and 1 - ALPHA/2 percentiles for the extremes, so that single voxels count for less.",
       "A dose in mJ/cm3, of a turn in full light or of vam-dose --exposure-plan, and resin.critical_dose_mj_cm3 also "
       "give the exposure: the fewest whole turns, their time, and the fraction of full light with which the critical "
       "dose lies in the middle of the process window.",
       "Voxels that the part's surface cuts (0 < coverage < 1) are judged only with --surface.",
       "With --require the exit status is 1 when a condition does not hold, so that a Makefile can refuse a part that "
       "will not print."},
      {{"Score what simple projections would print:",
        "vam-slice --shape disc-grid --voxel 0.2 -o part.vdb && vam-optimize part.vdb | vam-dose --like part.vdb -o "
        "dose.vdb && vam-score dose.vdb --target part.vdb"},
       {"Refuse a dose that will not print:", "vam-score dose.vdb --target part.vdb --require 'ver<=0.01,iou>=0.95'"},
       {"Look at the print, as a mesh and as points coloured by dose:",
        "vam-score dose.vdb --target part.vdb --print print.ply && vam-score dose.vdb --target part.vdb --print "
        "points.ply --print-as points"}},
      {"Accuracy: extremes, means and the figures at the critical dose are exact; VER, IoU and percentiles resolve the "
       "dose to 2^-12 of its value, and VER counts doubtful voxels as errors.",
       "Memory: both volumes as they are in their files, and 16 slices. --print holds the dose once more.",
       "Sources: Kelly et al., Computed Axial Lithography, 2017, fig 8 (print as points); Rackson et al., Object-space "
       "optimization of tomographic reconstructions, 2021 (VER, PW, IPDR)."},
      {"vam-dose", "vam-optimize", "vam-sdf", "vam-view"}};
}

void declare(cli::App& app, Options& options) {
  app.positional("DOSE", options.input, "Volume (VDB) with the dose.");
  app.option("--grid", "NAME", options.grid, "The grid to judge; 'scatter' judges what a camera saw.");
  app.option("--target", "FILE", options.target,
             "Volume with the grid 'target' of the same size and place. Without it the target in DOSE.");
  app.option("--sinogram", "FILE", options.sinogram, "The projections (EXR), for the efficiency of light.");
  app.group("Judgement");
  app.option("--require", "CONDITIONS", options.require,
             "Exit with 1 unless all hold, e.g. 'ver<=0.01,pw>=0'. The names are those of the table.");
  app.option("--critical-dose", "DOSE", options.how.threshold, cli::positive,
             "Also judge the print at this threshold. Without it resin.critical_dose_mj_cm3 if the dose is in mJ/cm3.");
  app.option("--trim", "ALPHA", options.how.trim, {0, 0.999}, "Fraction trimmed off both ends together.");
  app.flag("--surface", options.how.surface, "Judge surface voxels too: part when at least half covered.");
  app.flag("--absolute", options.how.absolute, "PW and IPDR in the dose's unit.");
  app.group("The print");
  app.option("--print", "FILE", options.print, "Write what prints as PLY, in mm.");
  app.choice("--print-as", options.print_as, {"mesh", "points"}, "Its surface, or its voxels coloured by dose.");
  app.option("--print-at", "DOSE", options.print_at, cli::positive,
             "Threshold of the print. Without it the critical dose, else the best threshold.");
  cli::add_printer(app, options.printer);
  app.group("Output and machine");
  app.flag("--json", options.json, "Print JSON instead of the table.");
  cli::add_report(app, options.report);
  cli::add_threads(app);
}

struct Inputs {
  std::vector<io::SparseVolume> volumes;
  std::size_t dose_at = 0;
  std::size_t target_at = 0;
  [[nodiscard]] const io::SparseVolume& dose() const { return volumes[dose_at]; }
  [[nodiscard]] const io::SparseVolume& target() const { return volumes[target_at]; }
};

Inputs read(const Options& options) {
  Inputs in;
  if (!options.target.empty()) {
    in.volumes.push_back(io::read_volume(options.input, options.grid));
    in.volumes.push_back(io::read_volume(options.target, "target"));
    in.target_at = 1;
    return in;
  }
  in.volumes = io::read_volumes(options.input);
  const auto find = [&](const std::string& name, const std::string& remedy) {
    for (std::size_t i = 0; i < in.volumes.size(); ++i) {
      if (in.volumes[i].name() == name) return i;
    }
    throw Error{Fault::data, options.input + ": has no grid '" + name + "'; " + remedy};
  };
  in.dose_at = find(options.grid, "name the grid to judge with --grid");
  in.target_at = find("target", "name the target's file with --target");
  return in;
}

void check_same_place(const Options& options, const model::Grid& dose, const model::Grid& target) {
  const auto text = [](const model::Grid& g) {
    return std::to_string(g.nx) + " x " + std::to_string(g.ny) + " x " + std::to_string(g.nz) + " voxels of " +
           format_number(g.voxel_mm) + " mm from (" + format_number(g.origin_mm[0]) + ", " +
           format_number(g.origin_mm[1]) + ", " + format_number(g.origin_mm[2]) + ")";
  };
  const double slack = 1e-3 * target.voxel_mm;
  bool same = dose.nx == target.nx && dose.ny == target.ny && dose.nz == target.nz &&
              std::abs(dose.voxel_mm - target.voxel_mm) <= slack / std::max({dose.nx, dose.ny, dose.nz, 1});
  for (std::size_t axis = 0; axis < 3; ++axis)
    same = same && std::abs(dose.origin_mm[axis] - target.origin_mm[axis]) <= slack;
  if (!same) {
    throw Error{Fault::data, options.input + ": the dose has " + text(dose) + ", but the target has " + text(target) +
                                 "; make the dose for this target"};
  }
}

metrology::Score score(const Inputs& in, const metrology::ScoreOptions& how) {
  constexpr int slab = 16;
  const model::Grid& grid = in.target().grid();
  metrology::Score result(how, grid.nx, grid.ny);
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

void write_print(const Options& options, const Inputs& in, double threshold) {
  const auto read_slices = [&](int k, int count, float* out) { in.dose().read_slices(k, count, out); };
  const std::vector<std::string> comments{"threshold dose " + format_number(threshold) + " " + in.dose().units};
  if (options.print_as == "mesh") {
    const auto mesh = solid::isosurface(in.dose().grid(), read_slices, threshold);
    if (mesh.triangles.empty()) throw Error{Fault::data, "nothing prints at a dose of " + format_number(threshold)};
    return io::write_ply(options.print, mesh, {}, comments);
  }
  const auto print = solid::printed_points(in.dose().grid(), read_slices, threshold);
  if (print.points.points.empty()) throw Error{Fault::data, "nothing prints at a dose of " + format_number(threshold)};
  io::write_ply(options.print, print.points, print.values, comments);
}

void run(Options& options) {
  std::vector<model::Condition> conditions;
  if (!options.require.empty()) conditions = model::parse_conditions(options.require, metrology::Score::names());
  const model::Printer printer = tool::load_printer(options.printer);
  if (tool::print_printer(options.printer, printer, "-")) return;
  for (const auto& output : {options.print, options.report}) {
    if (output.empty()) continue;
    io::refuse_same_file(options.input, output);
    if (!options.target.empty()) io::refuse_same_file(options.target, output);
  }
  const Inputs in = read(options);
  check_same_place(options, in.dose().grid(), in.target().grid());
  options.how.circle = model::writable_circle(in.target().grid(), printer);
  if (!options.how.threshold && in.dose().units == "mJ/cm3") options.how.threshold = printer.resin.critical_dose_mj_cm3;
  if (in.dose().units == "mJ/cm3" && printer.resin.critical_dose_mj_cm3) {
    const auto turns = in.dose().metadata.find("vam:full_light_turns");  // of vam-dose --exposure-plan
    options.how.exposure = {printer, turns == in.dose().metadata.end() ? 1.0 : std::stod(turns->second)};
  }
  metrology::Score result = score(in, options.how);
  if (!options.sinogram.empty()) {
    io::StackReader light(options.sinogram);
    Image image;
    for (model::ImageInfo about; light.next(image, about);) result.add_projection(image.values);
  }
  const Json figures = result.figures();
  if (!options.print.empty()) {
    const double best = result.figure("threshold");
    write_print(options, in, options.print_at.value_or(options.how.threshold.value_or(best)));
  }
  io::write_report(options.report, "vam-score/1", figures);
  io::write_text("-", options.json ? figures.dump(2) + "\n" : result.table());
  const auto failures = model::unmet(conditions, [&](const std::string& name) { return result.figure(name); });
  if (failures.empty()) return;
  std::string line;
  for (const auto& failure : failures) line += (line.empty() ? "" : "; ") + failure;
  throw Error{Fault::judged, line};
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(options); });
}
