// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "io/vdb/vdb.hpp"
#include "model/metadata.hpp"
#include "plot/image_figure.hpp"
#include "plot/page.hpp"
#include "plot/planes.hpp"
#include "vam-status/page.hpp"

namespace vam::status_tool {

namespace {

// x to the right, z up, in the heights of the print.
plot::ImageFigure section_of(const io::SparseVolume& volume) {
  const model::Grid& g = volume.grid();
  Image section = plot::planes(volume, plot::Plane::coronal, {g.ny / 2}).front();
  double most = 0.02;
  for (const float value : section.values) most = std::max(most, std::abs(static_cast<double>(value) - 1));
  const double stretch = model::stretch_z(volume.metadata);
  plot::ImageFigure figure;
  figure.panels.push_back({std::move(section), "", {}});
  figure.x = {"x (mm)", g.x_mm(-0.5), g.x_mm(g.nx - 0.5)};
  figure.y = {"z (mm)", g.z_mm(-0.5) / stretch, g.z_mm(g.nz - 0.5) / stretch};
  figure.scale = {plot::ColourMap::diverging, 1 - most, 1 + most, "dose that acts / planned dose"};
  figure.size = 480;
  return figure;
}

}  // namespace

std::string correction_text(const RunFolder& run) {
  Json line;
  for (LogLines log(run.file("renewed.jsonl")); log.next(line);) continue;
  if (!line.is_object()) return "";
  if (text_at(line, "event") == "hold") return "as before: " + text_at(line, "reason");
  const double turns = number_at(line, "turns");
  return "from turn " + format_number(number_at(line, "from_turn")) + " on, for " + format_number(turns) +
         (turns == 1 ? " turn" : " turns") + ": sensitivity " + format_number(number_at(line, "sensitivity"), 3);
}

std::string sensitivity_figure(const RunFolder& run) {
  const std::string path = run.file("renewed/sensitivity.vdb");
  try {
    if (!has_regular_file(path)) return "";
    const plot::ImageFigure figure = section_of(io::read_volume(path, "sensitivity"));
    return plot::page_figure(
        "Sensitivity of the resin", plot::page_image(plot::draw(figure).image(), "section"),
        "Section through the axis. Red: the resin cures ahead of its planned dose; blue: behind it.");
  } catch (const Error&) {
    return "";  // the page does not depend on it
  }
}

}  // namespace vam::status_tool
