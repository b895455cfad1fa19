// vam-view: pictures of any of the files, for people.
#include <string>

#include "base/error.hpp"
#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/file_type.hpp"
#include "io/nrrd.hpp"
#include "io/picture.hpp"
#include "io/stream.hpp"
#include "io/view.hpp"
#include "model/circle.hpp"
#include "printer.hpp"

namespace {

using namespace vam;

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string grid;
  std::string plane = "axial";
  std::string target;
  std::string exported;
  bool histogram = false;
  bool plain = false;
  io::ViewOptions view;
  cli::PrinterOptions printer;
};

cli::Manual manual() {
  return {
      "vam-view",
      "make a picture of a volume, a sinogram, frames or a video",
      {"vam-view looks at what is in the file, whatever its name: an OpenVDB volume (part, dose, scatter, distance), "
       "an OpenEXR stack (sinograms or frames), an FFV1 or H.264 video, or a folder of numbered pictures. It writes "
       "one PNG with axes in mm or degrees, a colour bar with the unit, and a scale bar where a pixel has a size.",
       "Of a volume it shows a section: axial (x to the right, y up), coronal (x to the right, z up) or sagittal (y to "
       "the right, z up), the middle one or the one at --at. Of sinograms it shows the middle slice, columns to the "
       "right and stage angles downwards; of frames the first one, upright as in the file. --sheet N shows N of them, "
       "evenly spread.",
       "--target draws the surface of the part (coverage 1/2) as a line over the dose. --histogram shows the doses "
       "inside and outside the part instead, as shares of the voxels on each side: where the two overlap, no threshold "
       "prints the part. Voxels that the surface cuts, and those outside the writable circle, are left out.",
       "Coverage and light are grey; dose and other amounts are viridis, in which equal steps look equal; signed "
       "values are blue, white and red with zero in the middle. --export writes the numbers as NRRD for ParaView, 3D "
       "Slicer or numpy."},
      {{"The part from the side, and a sheet of nine slices:",
        "vam-slice --shape gyroid --voxel 0.2 -o part.vdb && vam-view part.vdb --plane coronal -o side.png && vam-view "
        "part.vdb --sheet 9 -o sheet.png"},
       {"Its filtered sinogram:",
        "vam-sinogram part.vdb --filter ram-lak -o sino.exr && vam-view sino.exr -o sino.png"},
       {"The numbers for ParaView:", "vam-view part.vdb --export part.nrrd"}},
      {"Memory: the volume as it is in its file and the pictures shown; stacks go by one image at a time.",
       "Pixels are enlarged by whole factors, so that each voxel is a square of the same size; reduced pictures are "
       "averaged after colouring.",
       "Sources: the histogram is that of Orth et al., On-the-fly 3D metrology of volumetric additive manufacturing, "
       "2022, fig S6."},
      {"vam-dose", "vam-project", "vam-score", "vam-sinogram", "vam-slice"}};
}

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

void write_figure(const Options& options, const io::ImageFigure& figure, const io::PictureText& text) {
  if (!options.plain) return io::write_png(options.output, io::draw(figure), text);
  io::write_png(options.output, io::coloured(figure.panels.front().values, figure.colours, figure.low, figure.high),
                text);
}

io::SparseVolume target_for(const Options& options) {
  return io::read_volume(options.target.empty() ? options.input : options.target, "target");
}

void show_volume(const Options& options, const io::PictureText& text) {
  const std::string grid = options.histogram && options.grid.empty() ? "dose" : options.grid;
  const io::SparseVolume volume = io::read_volume(options.input, grid);
  if (!options.exported.empty()) return io::write_nrrd(options.exported, volume);
  if (options.histogram) {
    const model::Printer printer = tool::load_printer(options.printer);
    const auto circle = model::writable_circle(volume.grid(), printer);
    return io::write_png(options.output,
                         io::draw(io::dose_histogram(volume, target_for(options), circle, options.view)), text);
  }
  if (options.target.empty()) return write_figure(options, io::view_volume(volume, nullptr, options.view), text);
  const io::SparseVolume target = target_for(options);
  write_figure(options, io::view_volume(volume, &target, options.view), text);
}

void show_images(const Options& options, io::FileType type, const io::PictureText& text) {
  if (options.histogram || !options.target.empty()) {
    throw Error{Fault::data, options.input + ": --histogram and --target need a volume (VDB), but this holds pictures"};
  }
  if (!options.exported.empty()) {
    if (type != io::FileType::stack) throw Error{Fault::usage, "--export: needs a volume or an EXR stack"};
    io::StackReader stack(options.input);
    return io::write_nrrd(options.exported, stack);
  }
  const auto images = io::open_images(options.input, type);
  write_figure(options, io::view_images(*images, options.view), text);
}

void run(const cli::App& app, Options& options) {
  if (tool::print_printer(options.printer, options.output)) return;
  check(options);
  options.view.name = options.input == "-" ? "stdin" : options.input.substr(options.input.find_last_of('/') + 1);
  options.view.plane = options.plane == "axial"     ? io::Plane::axial
                       : options.plane == "coronal" ? io::Plane::coronal
                                                    : io::Plane::sagittal;
  const io::PictureText text{{"Comment", app.history()}};
  const io::FileType type = io::file_type(options.input);
  if (type == io::FileType::volume) return show_volume(options, text);
  show_images(options, type, text);
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(manual());
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}
