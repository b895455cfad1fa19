#include "vam-view/options.hpp"

#include "base/error.hpp"
#include "io/stream/stream.hpp"

namespace vam::view_tool {

void declare(cli::App& app, Options& options) {
  app.positional("FILE", options.input, "Volume (VDB), stack (EXR), video (MKV, MP4) or folder of pictures.");
  app.option("-o,--output", "FILE", options.output, "Write the PNG to FILE; - is standard output.");
  app.option("--export", "FILE", options.exported, "Write the numbers as NRRD instead of a picture.");
  app.group("What to show");
  app.option("--grid", "NAME", options.grid, "The grid of a volume; needed when it has several.");
  app.choice("--plane", options.plane, {"axial", "coronal", "sagittal"}, "Section of a volume.");
  app.option(
      "--at", "PLACE", options.view.at, cli::any,
      "The section, or the slice of a sinogram, nearest to this many mm; the frame nearest to this angle in degrees.");
  app.option("--sheet", "N", options.view.sheet, {1, 400}, "So many of them, evenly spread, on one sheet.");
  app.option("--target", "FILE", options.target, "Volume with the grid 'target', to outline or for --histogram.");
  app.flag("--histogram", options.histogram, "Doses inside and outside the part; without --target the one in FILE.");
  app.group("How to show it");
  app.choice("--colours", options.view.colours, {"auto", "grey", "viridis", "diverging"}, "Colours of the values.");
  app.option("--low", "VALUE", options.view.low, cli::any, "Value at the lower end of the colours or the histogram.");
  app.option("--high", "VALUE", options.view.high, cli::any, "Value at the upper end.");
  app.option("--size", "PX", options.view.size, {64, 16384}, "Longer side of the picture without its frame, about.");
  app.flag("--plain", options.plain, "The coloured pixels alone, one for each value.");
  cli::add_printer(app, options.printer);
}

void check(const Options& options) {
  const auto& view = options.view;
  if (view.low && view.high && *view.low >= *view.high) throw Error{Fault::usage, "--low: must be below --high"};
  if (view.at && view.sheet > 1) throw Error{Fault::usage, "--at: has no meaning with --sheet"};
  if (options.plain && (view.sheet > 1 || options.histogram))
    throw Error{Fault::usage, "--plain: shows one picture only"};
  const std::string& written = options.exported.empty() ? options.output : options.exported;
  io::refuse_same_file(options.input, written);
  if (!options.target.empty()) io::refuse_same_file(options.target, written);
}

}  // namespace vam::view_tool
