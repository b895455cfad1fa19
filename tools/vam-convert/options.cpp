// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-convert/options.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "io/stream/stream.hpp"
#include "model/metadata.hpp"

namespace vam::convert_tool {

namespace {

constexpr cli::Range on_image{-65536, 131072};  // also beside it
const std::vector<std::string> own_files{"VDB volumes", "EXR stacks"};
const std::vector<std::string> projected{"--geometry parallel", "--geometry vial"};

void declare_volume(cli::App& app, Options& options) {
  app.group("Volumes");
  app.option("--voxel", "MM", options.voxel_mm, {1e-4, 1000}, "The array is a volume with cubic voxels of this edge.")
      .form()
      .excludes(projected)
      .not_for(own_files);
  app.option("--grid", "NAME", options.grid, "Name of the grid, of a volume that is read or made.")
      .excludes(projected)
      .not_for({"EXR stacks"});
  app.default_is("the only one; target");
  app.group("Volumes", {"--voxel"});
  app.option("--origin", "X,Y,Z", options.origin_mm, 3, "Centre of the first voxel in mm; the axis is at x = y = 0.");
  app.default_is("that which puts the middle of the volume, or the voxel that --from has there, on the axis, at z = 0");
  app.option("--stretch-z", "FACTOR", options.stretch_z, cli::Range{model::least_stretch, model::most_stretch},
             "Interpolate the array along z to this multiple of its height, recorded as vam:stretch_z: for a target "
             "1/M_vp of the printer, as vam-slice has it.");
  app.brief("Stretch the array along z, a target by 1/M_vp of the printer. Default: 1.");
  app.default_is("1, with a warning if the print of a target will have another height than the array");
}

void declare_projections(cli::App& app, Options& options) {
  app.group("Projections", projected);
  app.choice("--geometry", options.geometry, {"none", "parallel", "vial"},
             "The array, images or video are projections: of an ideal parallel beam in the resin, or of the printer's "
             "projector, whose rays the vial refracts.")
      .form()
      .not_for(own_files);
  app.option("--pixel", "MM", options.pixel_mm, cli::positive, "Pitch of the columns at the rotation axis.");
  app.default_is("projector.pixel_mm");
  app.option("--slice-height", "MM", options.slice_height_mm, {1e-4, 5}, "Height of a slice.");
  app.default_is("that of the columns");
  app.option("--like", "FILE", options.like,
             "Volume (VDB) whose slices the stack gets: interpolated, or averaged where the rows are finer; with "
             "--geometry vial also those above and below that climbing rays light. vam-dose --like FILE needs them.")
      .reads()
      .brief("Volume (VDB) whose slices the stack gets. Default: those of the array or images.");
  app.default_is("the slices of the array, the rows of the images");
  app.option("--view-step", "DEG", options.view_step_deg, {-180, 180, false, true},
             "Stage angle from one projection to the next, negative for a stage that turns the other way. Frames that "
             "state more turns than they make are then all of the print.");
  app.default_is(
      "that of frames.csv beside the images, or of a video that states it; else one turn divided by the projections");
  app.option("--first-angle", "DEG", options.first_angle_deg, {-360, 360}, "Stage angle of the first projection.");
  app.default_is("0, or that of frames.csv");
  app.option("--speed", "DEG/S", options.speed_deg_s, {-3600, 3600, false, true},
             "Speed at which the stage turns while a video plays, negative for the other way: its frames are shown for "
             "as long as it states. Sets stage.speed_deg_s.")
      .excludes({"--view-step"});
  app.option("--axis-column", "PX", options.axis_column, on_image, "Column of the projections on which the axis lies.");
  app.default_is("that of --from; projector.axis_column in images as wide as the projector's, else the middle");
  app.option("--axis-row", "PX", options.axis_row, on_image,
             "Row of the images, or slice of the array, on which z = 0 lies.");
  app.default_is("projector.axis_row in images as high as the projector's, else the middle");
  app.choice(
         "--orientation", options.orientation,
         {"normal", "flip-columns", "flip-rows", "rotate-90", "rotate-180", "rotate-270"},
         "How the images were turned for the projector, clockwise; undone first. Those for a projector on its side, "
         "with rows along the axis, are rotate-90 or rotate-270.")
      .not_for({"arrays"});
  app.default_is("that of --from; normal");
}

}  // namespace

void declare(cli::App& app, Options& options) {
  app.positional("FILE", options.input,
                 "Array (.npy, .npz, HDF5, NRRD, TIFF of several pages), folder of numbered images (PNG, TIFF, EXR), "
                 "video (MKV, MP4), volume (VDB) or stack (EXR).")
      .reads();
  cli::add_output(app, options.output);
  app.choice("--from", options.from, programs(),
             "Program whose conventions count (vam-formats(7)): order of axes, angles, the place of the axis, rows of "
             "frames. Its angles are those of --view-step, --first-angle and --speed.")
      .not_for(own_files);
  app.group("Arrays", {}, own_files);
  app.option("--array", "NAME", options.array, "Name of the array in a .npz file, path of the dataset in an HDF5 file.")
      .not_for({"images", "arrays alone in a file"});
  app.default_is("the only one; of HDF5 the only one of 3 axes");
  app.option("--axes", "ORDER", options.axes,
             "Axes of the array from the slowest to the fastest, as NumPy indexes them: x, y and z of a volume; z, a "
             "(angle) and x (column) of projections. A minus before a letter reverses its axis.")
      .not_for({"images"});
  app.default_is("those of --from; zyx, zax");
  app.option("--full-scale", "VALUE", options.full_scale, cli::positive,
             "Value that becomes 1, full coverage or full intensity.");
  app.default_is("1; full grey of images");
  app.option("--value-unit", "TEXT", options.units, "Unit of the values, for the record.");
  declare_volume(app, options);
  declare_projections(app, options);
  cli::add_printer(app, options.printer);
  app.group("Stack", projected);
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  app.group("Performance");
  cli::add_threads(app);
  app.usual({"--output", "--array", "--axes", "--voxel", "--geometry", "--pixel", "--view-step", "--from",
             "--axis-column", "--orientation", "--printer", "--set"});
}

io::ArrayOptions array_of(const Options& options, const std::string& letters) {
  const Convention& program = convention_of(options.from);
  const std::string_view usual = letters == "zyx" ? program.volume_axes : program.projection_axes;
  const std::string stated = options.axes.empty() ? std::string(usual) : options.axes;
  io::ArrayOptions array{options.array};
  std::string order;
  for (std::size_t at = 0; at < stated.size(); ++at) {
    const bool reversed = stated[at] == '-' && at + 1 < stated.size();
    const std::size_t letter = letters.find(stated[at += reversed ? 1 : 0]);
    if (letter != std::string::npos) array.reversed[letter] = reversed;
    order += stated[at];
  }
  if (order.size() != 3 || !std::is_permutation(order.begin(), order.end(), letters.begin()))
    throw Error{Fault::usage, "--axes: '" + stated + "' is not an order of the letters " + letters};
  for (std::size_t i = 0; i < 3; ++i) array.axes[i] = static_cast<int>(order.find(letters[i]));
  return array;
}

void check_export(const Options& options) {
  if (options.output == "-" || options.output.ends_with(".npy") || options.output.starts_with("/dev/")) return;
  throw Error{Fault::usage, options.output +
                                ": a volume or stack is written as .npy; vam-view --export writes a volume as NRRD, "
                                "vam-score --mesh the surface "
                                "of a print"};
}

void check_import(const Options& options) {
  const bool volume = options.voxel_mm.has_value();
  if (!volume && options.geometry == "none") {
    throw Error{Fault::usage,
                io::input_name(options.input) +
                    ": the kind of data is not given; use --voxel MM for a volume, or --geometry parallel or "
                    "vial; a mesh is for vam-slice"};
  }
  const std::string ending = volume ? ".vdb" : ".exr";
  if (options.output == "-" || options.output.ends_with(ending) || options.output.starts_with("/dev/")) return;
  throw Error{Fault::usage, options.output + ": " + (volume ? "a volume" : "a stack") + " is written as " + ending};
}

}  // namespace vam::convert_tool
