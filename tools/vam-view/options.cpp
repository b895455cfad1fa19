// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-view/options.hpp"

#include <algorithm>
#include <filesystem>

#include "io/stream/stream.hpp"
#include "plot/save.hpp"

namespace vam::view_tool {

std::string file_name(const std::string& path) {
  return path == "-" ? "stdin" : path.substr(path.find_last_of('/') + 1);
}

std::vector<std::string> file_names(const Options& options) {
  std::vector<std::string> paths{options.input}, names;
  paths.insert(paths.end(), options.compare.begin(), options.compare.end());
  for (const std::string& path : paths) {
    const std::string name = file_name(path);
    const std::string folder = std::filesystem::path(path).parent_path().filename().string();
    const bool alone = std::ranges::count(paths, name, [](const auto& one) { return file_name(one); }) == 1;
    names.push_back(alone || folder.empty() ? name : folder + "/" + name);
  }
  return names;
}

namespace {

std::vector<std::string> outputs() {
  std::vector<std::string> endings = plot::figure_endings();
  endings.emplace_back(".mp4");
  return endings;
}

const std::vector<std::string> not_volumes{"stacks", "images", "meshes", "traces"};
const std::vector<std::string> not_sections{"meshes", "traces"};

}  // namespace

void declare(cli::App& app, Options& options) {
  app.positional("FILE", options.input,
                 "Volume (VDB), stack (EXR), video (MKV, MP4), folder of images, mesh (PLY, STL, OBJ, OFF, 3MF) or "
                 "trace (.csv).")
      .reads();
  app.option(
         "-o,--output", "FILE", options.output,
         "Write the figure to FILE: PNG, PDF or SVG, by the ending of its name, or MP4, with --render and --target: a "
         "movie of the print as it grows during the exposure; - is PNG to standard output.")
      .writes(outputs())
      .only_with({"--render"}, ".mp4")
      .only_with({"--target"}, ".mp4")
      .excludes({"--dpi", "--plain"}, ".pdf")
      .excludes({"--dpi", "--plain"}, ".svg");
  app.option("--export", "FILE", options.exported, "Write the values as NRRD instead of an image.")
      .writes({".nrrd"})
      .excludes({"--output", "--plane", "--at", "--sheet", "--target", "--dose-histogram", "--cure-map", "--render",
                 "--compare", "--crop", "--colours", "--low", "--high", "--image-size", "--dpi", "--title", "--plain"})
      .not_for({"images", "meshes", "traces"});
  app.group("Selection");
  app.option("--grid", "NAME", options.grid,
             "Name of the grid; required if the volume has several, except for a target with its insert.")
      .not_for(not_volumes);
  app.choice("--plane", options.plane, {"axial", "coronal", "sagittal"}, "Orientation of the section of a volume.")
      .not_for(not_volumes);
  app.option("--at", "PLACE", options.view.at, cli::any,
             "Show the section or sinogram slice nearest to PLACE in mm (of the print), or the frame nearest to PLACE "
             "in degrees.")
      .excludes({"--sheet"})
      .not_for(not_sections);
  app.default_is("the middle one, of a cure map one where much is missing; the first frame");
  app.option("--sheet", "N", options.view.sheet, {1, 400},
             "Number of evenly spaced sections, slices or frames on one sheet.")
      .not_for(not_sections);
  app.option("--target", "FILE", options.target,
             "Volume with the grid 'target', for the outline, --dose-histogram, --cure-map or --render.")
      .reads()
      .not_for(not_volumes);
  app.default_is("for --dose-histogram and --cure-map the grid in FILE, else none");
  app.flag("--dose-histogram", options.histogram, "Show the dose distributions inside and outside the part.")
      .excludes({"--plane", "--at", "--sheet", "--colours", "--image-size"})
      .not_for(not_volumes);
  app.flag("--cure-map", options.cure,
           "Show where the dose cures the part, where it is missing and where it overcures.")
      .excludes({"--dose-histogram", "--colours", "--low", "--high"})
      .not_for(not_volumes);
  app.flag("--render", options.render,
           "Show the body in three dimensions; with --target the print beside the target, false and missing cure in "
           "colour.")
      .excludes({"--dose-histogram", "--cure-map", "--plane", "--at", "--sheet", "--colours", "--low", "--high"})
      .not_for(not_volumes);
  app.option("--isovalue", "VALUE", options.threshold, cli::positive,
             "Dose, or other value of the grid, from which on it prints.")
      .only_with({"--cure-map", "--render"});
  app.default_is("as by vam-score; 0.5 without a target");
  app.option("--compare", "FILE", options.compare,
             "Further volume or trace, shown beside the first; of volumes also the difference.")
      .reads()
      .excludes({"--dose-histogram", "--cure-map", "--render"})
      .not_for({"stacks", "images", "meshes"});
  app.choice("--crop", options.crop, {"all", "part"},
             "What of a section is shown: all, or the target (--target, or the grid of FILE) and a margin.")
      .excludes({"--dose-histogram", "--render"}, "part")
      .not_for(not_volumes);
  app.group("Appearance");
  app.choice("--colours", options.view.colours, {"auto", "grey", "viridis", "diverging"}, "Colour map.")
      .not_for(not_sections);
  app.option("--low", "VALUE", options.view.low, cli::any, "Lower end of the colour map or the histogram.")
      .not_for(not_sections);
  app.default_is("the value below which one pixel in 1000 is, at most 0");
  app.option("--high", "VALUE", options.view.high, cli::any, "Upper end of the colour map or the histogram.")
      .not_for(not_sections);
  app.default_is("the value that one pixel in 1000 exceeds; 1 for coverage; for the histogram, the extremes");
  app.option("--image-size", "PX", options.view.size, {64, 16384},
             "Approximate length of the longer side of the image without axes and title.")
      .not_for({"traces", "plain pixels"});
  app.option("--dpi", "N", options.dpi, {24, 2400}, "Pixels per inch of a PNG; --image-size is at 96.");
  app.option("--title", "TEXT", options.title, "Title of the figure; '' omits it.");
  app.default_is("names of file and content");
  app.flag("--plain", options.plain, "Write only the colour-mapped values, one pixel each, without axes.")
      .excludes({"--sheet", "--target", "--dose-histogram", "--cure-map", "--render", "--compare", "--dpi", "--title"})
      .not_for({"traces"});
  cli::add_printer(app, options.printer);
  app.usual({"--output", "--export", "--grid", "--plane", "--at", "--sheet", "--target", "--dose-histogram",
             "--cure-map", "--render", "--compare", "--crop", "--title", "--printer", "--set"});
}

}  // namespace vam::view_tool
