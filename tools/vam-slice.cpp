// vam-slice: a shape to the target volume, with fractional coverage at its surface.
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/log.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/printer_file.hpp"
#include "io/report.hpp"
#include "io/stream.hpp"
#include "io/vdb.hpp"
#include "model/printer.hpp"
#include "solid/part.hpp"
#include "solid/shapes.hpp"

namespace {

using namespace vam;

struct Options {
  std::string output = "-";
  std::string shape;
  std::optional<double> voxel_mm;
  std::string extent = "part";
  solid::Placement placement;
  std::vector<double> rotate_deg;
  bool no_center = false;
  std::optional<double> stretch_z;
  std::string report;
  cli::PrinterOptions printer;
};

cli::Manual manual() {
  cli::Manual manual{
      "vam-slice",
      "turn a part into the target volume",
      {"Writes the grid target: for every voxel the fraction, 0 to 1, that the part fills. Coordinates are "
       "millimetres; "
       "x = y = 0 is the rotation axis, z points up along it, and z = 0 is the middle of the projector's rows."},
      {{"The gyroid of Orth et al. 2022, cell 7 mm, sheet 1 mm:", "vam-slice --shape gyroid -o gyroid.vdb"}},
      {},
      {"vam-sinogram", "vam-optimize", "vam-view"}};
  manual.notes.emplace_back("Shapes and their parameters, lengths in mm:");
  for (const std::string& line : solid::describe_shapes()) manual.notes.push_back(line);
  return manual;
}

void declare(cli::App& app, Options& options) {
  cli::add_output(app, options.output);
  app.option("--shape", "NAME:KEY=VALUE,...", options.shape, "A part by name; NOTES lists them with their parameters.");
  app.option("--voxel", "MM", options.voxel_mm, cli::positive, "Edge of a voxel; without it projector.pixel_mm.");
  app.choice("--extent", options.extent, {"part", "writable"},
             "Size of the volume in x and y: the part's bounding circle, or the whole writable circle.");
  app.group("Placement, in this order");
  app.option("--scale", "FACTOR", options.placement.scale, cli::positive, "Enlarge.");
  app.option("--rotate", "X,Y,Z", options.rotate_deg, 3, "Turn about x, then y, then z, in degrees, right-handed.");
  app.option("--fit", "MM", options.placement.fit_mm, cli::positive, "Scale so that the largest dimension is MM.");
  app.flag("--fit-writable", options.placement.fit_writable, "Scale to fill the writable cylinder.");
  app.flag("--no-center", options.no_center, "Keep the file's origin; else the bounding box is centred at 0.");
  app.option("--stretch-z", "FACTOR", options.stretch_z, cli::positive,
             "Stretch along z; without it 1/M_vp of the printer, which undoes the vertical magnification of the vial.");
  cli::add_printer(app, options.printer);
  app.group("Report and machine");
  cli::add_report(app, options.report);
  cli::add_threads(app);
}

void run(const cli::App& app, Options& options) {
  const model::Printer printer = io::load_printer(options.printer.file, options.printer.sets);
  if (options.printer.print) {
    io::OutputFile out(options.output, io::Content::text);
    out.write(io::printer_toml(printer));
    return out.commit();
  }
  if (options.shape.empty()) throw Error{Fault::usage, "no part; give --shape NAME"};
  solid::Placement& placement = options.placement;
  if (!options.rotate_deg.empty()) std::copy_n(options.rotate_deg.begin(), 3, placement.rotate_deg.begin());
  placement.centre = !options.no_center;
  placement.stretch_z = options.stretch_z.value_or(1 / model::vertical_magnification(printer));
  const double voxel_mm = options.voxel_mm.value_or(printer.projector.pixel_mm);

  const solid::Writable room = solid::writable(printer);
  const solid::Part part = solid::shape_part(options.shape, placement, room);
  solid::require_writable(part.extent, room, part.subject);
  const model::Grid grid =
      solid::grid_around(part.extent, voxel_mm, options.extent == "writable" ? room.radius_mm : 0, part.subject);

  io::SparseVolume target("target", grid);
  Progress progress("slicing", grid.nz);
  (void)solid::fill(part, grid, [&](int k0, int count, const float* slices) {
    target.write_slices(k0, count, slices);
    progress.tick(count);
  });
  target.history.push_back(app.history());
  target.metadata["vam:stretch_z"] = format_number(placement.stretch_z, 9);
  io::write_volume(options.output, target);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
