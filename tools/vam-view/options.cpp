#include "vam-view/options.hpp"

#include "base/error.hpp"
#include "io/stream/stream.hpp"
#include "plot/save.hpp"

namespace vam::view_tool {

void declare(cli::App& app, Options& options) {
  app.positional("FILE", options.input, "Volume (VDB), stack (EXR), video (MKV, MP4) or folder of images.").reads();
  app.option("-o,--output", "FILE", options.output,
             "Write the figure to FILE: PNG, PDF or SVG, by the ending of its name; - is PNG to standard output.")
      .writes(plot::figure_endings());
  app.option("--export", "FILE", options.exported, "Write the values as NRRD instead of an image.").writes({".nrrd"});
  app.group("Selection");
  app.option("--grid", "NAME", options.grid,
             "Name of the grid; required if the volume has several, except for a target with its insert.");
  app.choice("--plane", options.plane, {"axial", "coronal", "sagittal"}, "Orientation of the section of a volume.");
  app.option("--at", "PLACE", options.view.at, cli::any,
             "Show the section or sinogram slice nearest to PLACE in mm, or the frame nearest to PLACE in degrees.");
  app.default_is("the middle one; the first frame");
  app.option("--sheet", "N", options.view.sheet, {1, 400},
             "Number of evenly spaced sections, slices or frames on one sheet.");
  app.option("--target", "FILE", options.target,
             "Volume with the grid 'target', for the outline or for --dose-histogram.")
      .reads();
  app.default_is("for --dose-histogram the grid in FILE, else no outline");
  app.flag("--dose-histogram", options.histogram, "Show the dose distributions inside and outside the part.")
      .was("--histogram");
  app.group("Appearance");
  app.choice("--colours", options.view.colours, {"auto", "grey", "viridis", "diverging"}, "Colour map.");
  app.option("--low", "VALUE", options.view.low, cli::any, "Lower end of the colour map or the histogram.");
  app.default_is("the lowest value, at most 0");
  app.option("--high", "VALUE", options.view.high, cli::any, "Upper end of the colour map or the histogram.");
  app.default_is("the highest value; 1 for fractions");
  app.option("--image-size", "PX", options.view.size, {64, 16384},
             "Approximate length of the longer side of the image without axes and title.")
      .was("--size");
  app.option("--dpi", "N", options.dpi, {24, 2400}, "Pixels per inch of a PNG; it has 96 of --image-size.");
  app.option("--title", "TEXT", options.title, "Title of the figure; '' omits it.");
  app.default_is("names of file and content");
  app.flag("--plain", options.plain, "Write only the colour-mapped values, one pixel each, without axes.");
  cli::add_printer(app, options.printer);
}

void check(const Options& options) {
  const auto& view = options.view;
  if (view.low && view.high && *view.low >= *view.high) throw Error{Fault::usage, "--low: must be below --high"};
  if (view.at && view.sheet > 1) throw Error{Fault::usage, "--at: cannot be combined with --sheet"};
  if (options.plain && (view.sheet > 1 || options.histogram))
    throw Error{Fault::usage, "--plain: shows one image only; omit --sheet and --dose-histogram"};
  if (options.plain && plot::is_figure(options.output) && !options.output.ends_with(".png"))
    throw Error{Fault::usage, "--plain: writes pixels; --output must end in .png"};
  if (!options.exported.empty() && options.output != "-") {
    throw Error{Fault::usage, "--export: writes the values instead of the image; omit --output"};
  }
}

}  // namespace vam::view_tool
