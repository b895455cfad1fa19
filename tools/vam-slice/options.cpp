#include "vam-slice/options.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <map>

#include "base/error.hpp"

namespace vam::slice_tool {

void declare(cli::App& app, Options& options) {
  app.positional("PART", options.input, "Mesh, or folder of numbered pictures.");
  cli::add_output(app, options.output);
  app.option("--shape", "NAME:KEY=VALUE,...", options.shape,
             "A test part by name instead of PART, e.g. gyroid:cell=5,sheet=0.6; IMPLEMENTATION NOTES lists all.");
  app.option("--insert", "MESH", options.insert, "Object to print around, in the coordinates of PART.");
  app.option("--insert-shape", "NAME:KEY=VALUE,...", options.insert_shape,
             "The same by name; in mm, centred on the axis.");
  app.choice("--fill", options.fill, {"auto", "exact", "vote"},
             "How inside is found: exactly, which needs a closed mesh, by vote, or as the mesh allows.");
  app.option("--voxel", "MM", options.voxel_mm, cli::positive,
             "Edge of a voxel, and of a picture's pixel; without it projector.pixel_mm.");
  app.choice("--extent", options.extent, {"part", "writable"},
             "Size of the volume in x and y: the part's bounding circle, or the whole writable circle.");
  app.group("Placement, in this order");
  app.choice("--unit", options.unit, {"mm", "cm", "m", "in", "um"}, "Unit of the file's coordinates.");
  app.option("--scale", "FACTOR", options.placement.scale, cli::positive, "Enlarge.");
  app.option("--rotate", "X,Y,Z", options.rotate_deg, 3, "Turn about x, then y, then z, in degrees, right-handed.");
  app.option("--fit", "MM", options.placement.fit_mm, cli::positive, "Scale so that the largest dimension is MM.");
  app.flag("--fit-writable", options.placement.fit_writable, "Scale to fill the writable cylinder.");
  app.flag("--no-center", options.no_center,
           "Keep the file's origin; without it the middle of the bounding box comes to x = y = z = 0.");
  app.option("--stretch-z", "FACTOR", options.stretch_z, cli::positive,
             "Stretch along z; without it 1/M_vp of the printer.");
  cli::add_printer(app, options.printer);
  app.group("Report and machine");
  cli::add_report(app, options.report);
  cli::add_threads(app);
}

bool is_folder(const std::string& path) {
  struct stat about {};
  return stat(path.c_str(), &about) == 0 && S_ISDIR(about.st_mode);
}

void check(const cli::App& app, const Options& options) {
  if (!options.shape.empty() && options.input != "-") {
    throw Error{Fault::usage, options.input + ": give either PART or --shape"};
  }
  if (options.placement.fit_mm && options.placement.fit_writable) {
    throw Error{Fault::usage, "--fit-writable: give either --fit or --fit-writable"};
  }
  if (options.placement.fit_writable && options.no_center) {
    throw Error{Fault::usage, "--fit-writable: centres the part; leave --no-center out"};
  }
  if (!options.insert.empty() && !options.insert_shape.empty()) {
    throw Error{Fault::usage, "--insert-shape: give either --insert or --insert-shape"};
  }
  if (options.insert == "-") throw Error{Fault::usage, "--insert: must be a file; standard input is for PART"};
  if (!options.shape.empty() || is_folder(options.input)) {
    if (app.given("--unit")) throw Error{Fault::usage, "--unit: is for meshes"};
    if (app.given("--fill")) throw Error{Fault::usage, "--fill: is for meshes"};
  }
  if (is_folder(options.input)) {
    for (const char* flag : {"--scale", "--rotate", "--fit", "--fit-writable", "--no-center", "--insert"}) {
      if (app.given(flag))
        throw Error{Fault::usage, std::string(flag) + ": pictures are taken as they are; use --voxel"};
    }
  }
}

void settle(Options& options, const model::Printer& printer) {
  solid::Placement& placement = options.placement;
  static const std::map<std::string, double> mm_per{{"mm", 1}, {"cm", 10}, {"m", 1000}, {"in", 25.4}, {"um", 1e-3}};
  placement.scale *= mm_per.at(options.unit);
  if (!options.rotate_deg.empty()) std::copy_n(options.rotate_deg.begin(), 3, placement.rotate_deg.begin());
  placement.centre = !options.no_center;
  placement.stretch_z = options.stretch_z.value_or(1 / model::vertical_magnification(printer));
  if (!options.voxel_mm) options.voxel_mm = printer.projector.pixel_mm;
}

}  // namespace vam::slice_tool
