// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/image/image_file.hpp"
#include "io/image/view_source.hpp"
#include "io/settings/sealed_text.hpp"
#include "metrology/compare/emboss.hpp"
#include "model/conditions.hpp"
#include "plot/contour.hpp"
#include "plot/image_figure.hpp"
#include "plot/plot.hpp"
#include "plot/save.hpp"
#include "session/surface.hpp"
#include "vam-sdf/options.hpp"

namespace vam::sdf_tool {

namespace {

constexpr double um_per_mm = 1000;

// Heights in mm, not a number where there was no reading; of a mesh or volume what is seen from above.
Image read_heights(const HeightOptions& options) {
  const bool levels = io::is_image_file(options.image);
  const bool stack = options.image == "-" || options.image.ends_with(".exr");
  const double unit_mm = levels || stack ? options.full_mm : 1.0;
  Image heights = levels || stack ? io::read_field(options.image)
                                  : solid::height_map(session::read_surface(options.image, options.design_isovalue),
                                                      options.pixel_mm)
                                        .heights_mm;
  for (float& h : heights.values) {
    const bool lost = levels && h == 0;
    const double mm = static_cast<double>(h) * unit_mm;
    const bool kept = !lost && !(options.lowest_mm && mm < *options.lowest_mm);
    h = kept ? static_cast<float>(mm) : std::numeric_limits<float>::quiet_NaN();
  }
  return heights;
}

metrology::EmbossAlign align_of(const std::string& word) {
  if (word == "none") return metrology::EmbossAlign::none;
  return word == "icp" ? metrology::EmbossAlign::near : metrology::EmbossAlign::any_turn;
}

// The ends of the section: as given, or down the middle column [RAY21 fig 8].
std::vector<double> line_of(const HeightOptions& options, const Image& image) {
  if (options.line.empty()) return {0.5 * (image.width - 1), 0, 0.5 * (image.width - 1), image.height - 1.0};
  for (std::size_t i = 0; i < 4; ++i) {
    const double end = i % 2 == 0 ? image.width - 1.0 : image.height - 1.0;
    if (!(options.line[i] >= 0 && options.line[i] <= end))
      throw Error{Fault::usage, "--line: " + format_number(options.line[i]) + " is outside the image of " +
                                    std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels"};
  }
  return options.line;
}

void draw_map(const HeightOptions& options, const metrology::Relief& print, const metrology::Emboss& found,
              const std::vector<double>& line) {
  plot::ImageFigure figure;
  Image um = print.heights_mm;
  for (float& h : um.values) h *= static_cast<float>(um_per_mm);
  figure.title = "Height of the print, design shrunk by " + format_number(100 * (1 - found.placing.scale), 3) + " %";
  figure.scale.low = -0.1 * um_per_mm * print.plateau_mm;
  figure.scale.high = 1.2 * um_per_mm * std::max(print.plateau_mm, found.height_mm);
  figure.scale.label = "height (µm)";
  figure.outline_name = "design at half height";
  figure.x = {"mm", 0, um.width * print.pixel_mm};
  figure.y = {"mm", 0, um.height * print.pixel_mm};
  plot::Panel panel{um, "", plot::contour(found.design, static_cast<float>(0.5 * found.design_height_mm))};
  if (std::find(print.measured.values.begin(), print.measured.values.end(), 0.0F) != print.measured.values.end()) {
    panel.hatched = print.measured;
    for (float& lost : panel.hatched.values) lost = 1 - lost;
    figure.hatched_name = "no reading";
  }
  if (!options.plot.empty()) panel.outline.push_back({{line[0], line[1]}, {line[2], line[3]}});
  figure.panels.push_back(std::move(panel));
  plot::save(options.output, plot::draw(figure));
}

void draw_section(const std::string& path, const metrology::Section& section) {
  plot::Plot plot;
  plot.title = "Height along the line";
  plot.x = {"mm"};
  plot.y = {"height (µm)"};
  const auto um = [](std::vector<double> mm) {
    for (double& h : mm) h *= um_per_mm;
    return mm;
  };
  plot.series.push_back({"design", section.along_mm, um(section.design_mm), plot::paint::grey});
  plot.series.push_back({"print", section.along_mm, um(section.print_mm), plot::paint::blue});
  plot::save(path, plot::draw(plot));
}

}  // namespace

void height(const HeightOptions& options) {
  std::vector<model::Condition> conditions;
  if (!options.require.empty()) conditions = model::parse_conditions(options.require, metrology::emboss_names());
  const model::TriangleSoup design = session::read_surface(options.design, options.design_isovalue);
  const Image heights = read_heights(options);
  const std::vector<double> line = line_of(options, heights);
  const metrology::Relief print = metrology::levelled(heights, options.pixel_mm);
  const auto found =
      metrology::compare_emboss(print, solid::height_map(design, options.pixel_mm), align_of(options.align));
  if (!options.output.empty()) draw_map(options, print, found, line);
  if (!options.plot.empty())
    draw_section(options.plot, metrology::section(print, found, line[0], line[1], line[2], line[3]));
  io::write_report(options.report, "vam-sdf-height", metrology::to_json(print, found));
  note("shrinkage " + format_number(100 * (1 - found.placing.scale), 3) + " %, outline RMS " +
       format_number(found.outline_rms_mm, 3) + " mm, height " + format_number(found.height_mm, 3) + " mm of " +
       format_number(found.design_height_mm, 3) + " mm, overlap " + format_number(100 * found.iou, 3) + " %");
  model::require_met(conditions, [&](const std::string& name) { return metrology::figure(found, name); });
}

}  // namespace vam::sdf_tool
