// vam-slice: a mesh, numbered pictures or a shape to the target volume, with fractional coverage at its surface.
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/mesh_file.hpp"
#include "io/picture.hpp"
#include "io/report.hpp"
#include "io/stream.hpp"
#include "io/vdb.hpp"
#include "model/printer.hpp"
#include "printer.hpp"
#include "solid/part.hpp"
#include "solid/shapes.hpp"

namespace {

using namespace vam;

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string shape;
  std::string insert;
  std::string insert_shape;
  std::string fill = "auto";
  std::optional<double> voxel_mm;
  std::string extent = "part";
  std::string unit = "mm";
  solid::Placement placement;
  std::vector<double> rotate_deg;
  bool no_center = false;
  std::optional<double> stretch_z;
  std::string report;
  cli::PrinterOptions printer;
};

const std::map<std::string, double> mm_per{{"mm", 1}, {"cm", 10}, {"m", 1000}, {"in", 25.4}, {"um", 1e-3}};

cli::Manual manual() {
  cli::Manual manual{
      "vam-slice",
      "turn a mesh, pictures or a test part into the target volume",
      {"Writes the grid 'target': for every voxel the fraction, 0 to 1, that the part fills. Coordinates are "
       "millimetres; x = y = 0 is the rotation axis, z points up along it, and z = 0 is the middle of the projector's "
       "rows (projector.axis_row). A second grid, 'insert', holds an opaque object that is printed around.",
       "PART is a mesh (STL, OBJ, PLY, OFF or 3MF, told by its content), or a folder of numbered grey pictures (PNG or "
       "TIFF), one for each slice from the lowest up, white inside, each pixel a voxel. --shape makes a test part "
       "without any file.",
       "Meshes are repaired first: equal points welded, cracks of rounding closed, degenerate and duplicate triangles "
       "dropped, all others turned outwards. Solids may overlap; what has several shells is a solid within a solid, or "
       "a cavity where the inner shell faces inwards in the file. What was done is said in a warning. When holes "
       "remain, inside is decided by a vote: along x, y and z each, windings are counted from both ends of every row "
       "of voxels, and the median decides. A surface that encloses nothing is an error.",
       "The vial shrinks the picture of a projector that is not telecentric vertically, by M_vp < 1 (Orth et al. "
       "2022). The target is therefore stretched along z by 1/M_vp, so that slices are rows of the projector and the "
       "print comes out in its true height. --stretch-z 1 switches this off. The factor is recorded as vam:stretch_z."},
      {{"The gyroid of Orth et al. 2022, cell 7 mm, sheet 1 mm, in a cylinder of 14 mm x 10 mm:",
        "vam-slice --shape gyroid -o gyroid.vdb"},
       {"The disc grid of Orth et al. 2021 on a coarser grid, and what was measured:",
        "vam-slice --shape disc-grid:height=1 --voxel 0.13 --report discs.json -o discs.vdb"},
       {"A boat as large as the printer allows:", "vam-slice --shape boat --fit-writable --voxel 0.13 -o boat.vdb"},
       {"A handle to be printed around the shaft of a screwdriver:",
        "vam-slice --shape handle --insert-shape screwdriver --voxel 0.13 -o handle.vdb"}},
      {},
      {"vam-optimize", "vam-sdf", "vam-sinogram", "vam-view"}};
  manual.notes = {
      "Accuracy: coverage by a closed mesh is exact (divergence theorem on triangles cut to voxels; 1e-6). Where the "
      "surfaces of two overlapping solids cross within a voxel its coverage is their sum, at most 1. With holes of 8 % "
      "of the diameter or 0.5 % of the facets missing, fewer than one voxel in 1000 is wrong by more than a half. "
      "Shapes: 2e-4 of the volume for features of a few voxels.",
      "Speed and memory: a million triangles on 512 x 512 x 512 voxels take 2 s on two cores. In memory are the mesh, "
      "16 slices, and the volume with its interior as tiles.",
      "The volume is square in x and y and just holds the part's bounding circle; metrics that look at the void use "
      "the writable circle, whatever the size of the volume. --extent writable makes volumes of several parts match.",
      "Sources: [CAL17] Kelly et al., Computed Axial Lithography, 2017; [CAL19] Kelly et al., Science 2019; [RAY21] "
      "Orth et al., Opt. Express 2021; [OST22] Orth et al., On-the-fly 3D metrology, 2022; [CURE19] Pritchard et al., "
      "2019.",
      "The shapes, with their parameters and defaults (mm and counts):"};
  for (const std::string& line : solid::describe_shapes()) manual.notes.push_back(line);
  return manual;
}

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

solid::FillMode fill_mode(const Options& options) {
  if (options.fill == "exact") return solid::FillMode::exact;
  return options.fill == "vote" ? solid::FillMode::vote : solid::FillMode::automatic;
}

solid::Part picture_part(const Options& options, double voxel_mm) {
  const auto folder = std::make_shared<io::PictureFolder>(options.input);
  const GreyImage first = folder->read(0);
  solid::PictureStack stack{first.width, first.height, folder->count(), [folder](int index) {
                              const GreyImage grey = folder->read(index);
                              Image image(grey.width, grey.height);
                              for (std::size_t i = 0; i < image.size(); ++i) {
                                image.values[i] = static_cast<float>(grey.values[i]) / static_cast<float>(grey.full());
                              }
                              return image;
                            }};
  return solid::picture_part(std::move(stack), options.input, voxel_mm, options.placement.stretch_z);
}

solid::Part part_of(const Options& options, const solid::Writable& room, double voxel_mm) {
  if (!options.shape.empty()) return solid::shape_part(options.shape, options.placement, room);
  if (is_folder(options.input)) return picture_part(options, voxel_mm);
  model::TriangleSoup mesh = io::read_mesh(options.input);
  const std::string subject = options.input == "-" ? "stdin" : options.input;
  const solid::Affine map = solid::place(mesh, options.placement, room, subject);
  return solid::mesh_part(std::move(mesh), subject, map, fill_mode(options));
}

std::optional<solid::Part> insert_of(const Options& options, const solid::Part& part, const solid::Writable& room) {
  if (!options.insert.empty()) {
    return solid::mesh_part(io::read_mesh(options.insert), options.insert, part.map, solid::FillMode::automatic);
  }
  if (options.insert_shape.empty()) return std::nullopt;
  solid::Placement upright;
  upright.stretch_z = options.placement.stretch_z;
  return solid::shape_part(options.insert_shape, upright, room);
}

void say_repairs(const solid::Part& part) {
  if (!part.repair || (!part.repair->changed() && part.repair->closed())) return;
  warn(part.subject + ": " + part.repair->summary() + (part.repair->closed() ? "" : "; inside is decided by vote"));
}

io::SparseVolume volume_of(const std::string& name, const solid::Part& part, const model::Grid& grid,
                           solid::Content& content) {
  io::SparseVolume volume(name, grid);
  Progress progress("slicing", grid.nz);
  content = solid::fill(part, grid, [&](int k0, int count, const float* slices) {
    volume.write_slices(k0, count, slices);
    progress.tick(count);
  });
  say_repairs(part);
  return volume;
}

void run(const cli::App& app, Options& options) {
  check(app, options);
  const model::Printer printer = tool::load_printer(options.printer);
  if (tool::print_printer(options.printer, printer, options.output)) return;
  solid::Placement& placement = options.placement;
  placement.scale *= mm_per.at(options.unit);
  if (!options.rotate_deg.empty()) std::copy_n(options.rotate_deg.begin(), 3, placement.rotate_deg.begin());
  placement.centre = !options.no_center;
  placement.stretch_z = options.stretch_z.value_or(1 / model::vertical_magnification(printer));
  const double voxel_mm = options.voxel_mm.value_or(printer.projector.pixel_mm);
  for (const std::string& input : {options.input, options.insert}) {
    if (!input.empty()) io::refuse_same_file(input, options.output);
  }

  const solid::Writable room = solid::writable(printer);
  const solid::Part part = part_of(options, room, voxel_mm);
  solid::require_writable(part.extent, room, part.subject);
  double radius_mm = options.extent == "writable" ? room.radius_mm : 0;
  const std::optional<solid::Part> insert = insert_of(options, part, room);
  if (insert) {
    solid::require_within(insert->extent, model::resin_radius_mm(printer.vial), insert->subject);
    radius_mm = std::max(radius_mm, insert->extent.radius_mm);
  }
  const model::Grid grid = solid::grid_around(part.extent, voxel_mm, radius_mm, part.lattice, part.subject);

  solid::Content content;
  std::vector<io::SparseVolume> volumes;
  volumes.push_back(volume_of("target", part, grid, content));
  const Json report = solid::figures(part, content, grid, placement.stretch_z, room);
  if (insert) volumes.push_back(volume_of("insert", *insert, grid, content));
  for (io::SparseVolume& volume : volumes) {
    volume.history.push_back(app.history());
    volume.metadata["vam:printer"] = io::printer_settings(printer);
    volume.metadata["vam:stretch_z"] = format_number(placement.stretch_z, 9);
  }
  io::write_volumes(options.output, volumes);
  io::write_report(options.report, "vam-slice/1", report);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
