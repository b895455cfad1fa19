#include "vam-view/options.hpp"

#include "base/error.hpp"
#include "io/stream/stream.hpp"

namespace vam::view_tool {

void declare(cli::App& app, Options& options) {
  app.positional("FILE", options.input, "Volume (VDB), stack (EXR), video (MKV, MP4) or folder of images.").reads();
  app.option("-o,--output", "FILE", options.output, "Write the PNG to FILE; - is standard output.").writes({".png"});
  app.option("--export", "FILE", options.exported, "Write the values as NRRD instead of an image.").writes({".nrrd"});
  app.group("Selection");
  app.option("--grid", "NAME", options.grid,
             "Grid of the volume. Required if the volume has more than one, but for a target with its insert.");
  app.choice("--plane", options.plane, {"axial", "coronal", "sagittal"}, "Orientation of the section of a volume.");
  app.option("--at", "PLACE", options.view.at, cli::any,
             "Show the section or sinogram slice nearest to PLACE in mm, or the frame nearest to PLACE in degrees.");
  app.default_is("the middle one; of frames the first");
  app.option("--sheet", "N", options.view.sheet, {1, 400},
             "Number of sections, slices or frames on one sheet, evenly spaced.");
  app.option("--target", "FILE", options.target, "Volume with the grid 'target', for the outline or for --histogram.")
      .reads();
  app.default_is("for --histogram the grid in FILE, else no outline");
  app.flag("--histogram", options.histogram, "Show dose distributions inside and outside the part.");
  app.group("Appearance");
  app.choice("--colours", options.view.colours, {"auto", "grey", "viridis", "diverging"}, "Colour map.");
  app.option("--low", "VALUE", options.view.low, cli::any, "Lower end of the colour map or the histogram.");
  app.default_is("the lowest value, at most 0");
  app.option("--high", "VALUE", options.view.high, cli::any, "Upper end of the colour map or the histogram.");
  app.default_is("the highest value; 1 for fractions");
  app.option("--size", "PX", options.view.size, {64, 16384},
             "Approximate length of the longer side of the image without its frame.");
  app.flag("--plain", options.plain, "Write the colour-mapped pixels only, one for each value.");
  cli::add_printer(app, options.printer);
}

void check(const Options& options) {
  const auto& view = options.view;
  if (view.low && view.high && *view.low >= *view.high) throw Error{Fault::usage, "--low: must be below --high"};
  if (view.at && view.sheet > 1) throw Error{Fault::usage, "--at: cannot be combined with --sheet"};
  if (options.plain && (view.sheet > 1 || options.histogram))
    throw Error{Fault::usage, "--plain: shows one image only; leave out --sheet and --histogram"};
  if (!options.exported.empty() && options.output != "-") {
    throw Error{Fault::usage, "--export: writes the values instead of the image; leave out --output"};
  }
}

}  // namespace vam::view_tool
