// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-slice/options.hpp"

#include <sys/stat.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "model/magnification.hpp"
#include "model/metadata.hpp"
#include "solid/voxel/size_doubt.hpp"

namespace vam::slice_tool {

namespace {

const std::vector<std::string> not_a_mesh{"images", "test parts"};

void declare_placement(cli::App& app, Options& options) {
  app.group("Placement, applied in this order");
  app.choice("--unit", options.unit, solid::unit_names(), "Unit of the file's coordinates.").not_for(not_a_mesh);
  app.choice("--mirror", options.mirror, {"none", "x", "y", "z"},
             "Mirror the part, and the file of --insert with it, by negating this coordinate.")
      .not_for({"images"});
  app.choice("--up", options.up, {"x", "y", "z", "-x", "-y", "-z"},
             "Axis of the file that points upwards; y in the files of most animation programs.")
      .not_for({"images"});
  app.option("--scale", "FACTOR", options.placement.scale, cli::positive, "Scale factor.").not_for({"images"});
  app.option("--rotate", "X,Y,Z", options.rotate_deg, 3,
             "Rotation angles in degrees about x, then y, then z, right-handed.")
      .not_for({"images"});
  session::add_array(app, options.array, not_a_mesh, {"--insert", "--insert-shape", "--compensate", "--no-centre"});
  app.option("--fit", "MM", options.placement.fit_mm, cli::positive,
             "Scale the part so that its largest dimension is MM.")
      .excludes({"--unit", "--scale"})
      .not_for({"images"});
  app.flag(
      "--fit-writable", options.placement.fit_writable,
      "Scale the part to fill the writable cylinder, within which resin is lit from all stage angles. Refused where no "
      "voxel would be half covered then.");
  app.excludes({"--unit", "--scale", "--fit", "--no-centre", "--extent resin"}).not_for({"images"});
  app.flag("--no-centre", options.no_centre,
           "Keep the origin of the file, instead of moving the centre of the bounding box to x = y = z = 0.")
      .not_for(not_a_mesh);
  app.option("--place", "MM|auto", options.place,
             "Vertical offset of the part from the height of the lens (projector.axis_row), in mm of the print, "
             "rounded to whole voxels. auto: the offset at which climbing rays blur its horizontal faces least. The "
             "report contains the offset.");
  app.default_is("0, or the smallest offset at which the part lies within the image");
  app.flag("--any-height", options.any_height,
           "Allow a part that is taller than the projected image, for vam-optimize --helix or --poses.")
      .excludes({"--place auto"});
  app.option("--stretch-z", "FACTOR", options.stretch_z, cli::Range{model::least_stretch, model::most_stretch},
             "Stretch factor along z.");
  app.default_is("1/M_vp of the printer");
}

void declare_insert(cli::App& app, Options& options) {
  const std::string heading = "Insert, an object to print around";
  app.group(heading);
  app.option("--insert", "MESH", options.insert,
             "Mesh of the insert, in its own size. Its origin is that of PART's file, and it is rotated with PART.")
      .reads()
      .not_for({"images"});
  app.option("--insert-shape", "NAME:KEY=VALUE,...", options.insert_shape,
             "Insert by name, as --shape; centred on the axis.")
      .excludes({"--insert"});
  app.choice("--insert-unit", options.insert_unit, solid::unit_names(), "Unit of MESH.").only_with({"--insert"});
  app.group(heading, {"--insert", "--insert-shape"});
  app.option("--insert-scale", "FACTOR", options.insert_scale, cli::positive, "Scale factor of the insert.");
  app.option("--insert-rotate", "X,Y,Z", options.insert_rotate_deg, 3,
             "Rotation angles of the insert, as --rotate, instead of those of PART.");
  app.option("--insert-at", "X,Y,Z", options.insert_at_mm, 3,
             "Position of the centre of the insert's bounding box, in mm of the print, before --place moves it with "
             "the part; x = y = 0 is the axis.");
  app.option("--cut-insert", "CLEARANCE_MM", options.clearance_mm, cli::non_negative,
             "Subtract the insert from the part, with this clearance all around.")
      .when_left_out("0");
}

}  // namespace

void declare(cli::App& app, Options& options) {
  app.positional("PART", options.input, "Mesh, or folder of numbered images.").reads({"--shape"});
  cli::add_output(app, options.output).writes_as({".vdb", ".toml"});
  app.option("--shape", "NAME:KEY=VALUE,...", options.shape,
             "Test part by name instead of PART, e.g. gyroid:cell=5,sheet=0.6; listed in IMPLEMENTATION NOTES.")
      .form();
  app.choice(
         "--fill", options.fill, {"auto", "exact", "vote", "wrap"},
         "Inside test: exact (closed meshes), by majority (vote; meshes with holes), or chosen automatically. wrap: "
         "replace the mesh by a closed surface around it, for scans whose inside no vote settles.")
      .not_for(not_a_mesh);
  app.option("--wrap", "ALPHA,OFFSET", options.wrap_mm, 2,
             "Of --fill wrap: openings narrower than 2 ALPHA are closed, and the part is larger by up to OFFSET on all "
             "sides, both in mm, OFFSET from ALPHA/100 to ALPHA.")
      .only_with({"--fill wrap"});
  app.default_is("2 and 1/8 voxels");
  app.option(
         "--compensate", "SDF.vdb", options.compensate,
         "Correct the mesh by the deviation of its print, a volume of vam-sdf --volume against the same mesh. Once "
         "for each round, in their order; the corrections of the best print are applied, not its own and later ones.")
      .reads()
      .excludes({"--unit", "--scale", "--fit", "--fit-writable"})
      .not_for(not_a_mesh);
  app.option("--damping", "FRACTION", options.damping, {0.05, 1}, "Fraction of each deviation that is corrected.")
      .only_with({"--compensate"});
  app.option("--voxel", "MM", options.voxel_mm, cli::positive,
             "Edge of a voxel, and of an image pixel. Multiples of projector.pixel_mm are slices of whole rows, which "
             "the projector shows as they are; those between mix neighbouring slices.");
  app.default_is("projector.pixel_mm");
  app.choice("--extent", options.extent, {"part", "writable", "resin"},
             "Lateral size of the volume: the bounding circle of the part, the writable circle, or the whole "
             "cross-section of the resin. With resin the part may extend beyond the writable radius, where resin is "
             "lit from some stage angles only.");
  declare_placement(app, options);
  declare_insert(app, options);
  cli::add_printer(app, options.printer);
  app.group("Report and performance");
  cli::add_report(app, options.report);
  cli::add_threads(app);
  app.usual({"--output", "--shape", "--voxel", "--unit", "--up", "--scale", "--rotate", "--fit", "--fit-writable",
             "--place", "--insert", "--printer", "--set", "--report"});
}

bool is_folder(const std::string& path) {
  struct stat about {};
  return stat(path.c_str(), &about) == 0 && S_ISDIR(about.st_mode);
}

void check(const cli::App& app, const Options& options) {
  if (const auto& mm = options.wrap_mm; !mm.empty() && !(mm[0] > 0 && mm[1] >= 0.01 * mm[0] && mm[1] <= mm[0])) {
    throw Error{Fault::usage, "--wrap: an offset of " + format_number(mm[1]) + " mm for " + format_number(mm[0]) +
                                  " mm; give ALPHA above 0 and OFFSET from ALPHA/100 to ALPHA"};
  }
  if (!options.shape.empty()) return app.require_for("test parts", options.shape);
  app.require_for(is_folder(options.input) ? "images" : "meshes", options.input);
}

solid::PlacementAdvice advice(const Options& options) {
  solid::PlacementAdvice advice;
  advice.size = "--scale";
  advice.value = options.placement.scale / solid::mm_per(options.unit);
  advice.stretch_z = options.placement.stretch_z;
  advice.or_fit = " or --fit-writable";
  if (options.placement.fit_mm) {
    advice.size = "--fit";
    advice.value = *options.placement.fit_mm;
  }
  if (is_folder(options.input)) {
    advice.size = "--voxel";
    advice.value = options.voxel_mm.value();
    advice.or_fit.clear();
  }
  advice.off_axis = "omit --no-centre; ";
  advice.beyond = ", or --extent resin to accept resin that is lit from some angles only";
  advice.too_high = "--place auto finds a height within them";
  advice.too_tall = ", or --any-height to accept it for vam-optimize --helix";
  return advice;
}

void resolve(Options& options, const model::Printer& printer) {
  solid::Placement& placement = options.placement;
  placement.scale *= solid::mm_per(options.unit);
  placement.axes = solid::upright(options.up);
  if (options.mirror != "none") placement.axes = placement.axes * solid::mirrored(options.mirror);
  if (!options.rotate_deg.empty()) std::copy_n(options.rotate_deg.begin(), 3, placement.rotate_deg.begin());
  placement.centre = !options.no_centre;
  placement.stretch_z = options.stretch_z.value_or(1 / model::vertical_magnification(printer));
  if (!options.voxel_mm) options.voxel_mm = printer.projector.pixel_mm;
  placement.voxel_mm = *options.voxel_mm;
  if (options.wrap_mm.empty()) options.wrap_mm = {2 * *options.voxel_mm, *options.voxel_mm / 8};
}

}  // namespace vam::slice_tool
