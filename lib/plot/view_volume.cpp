// SPDX-License-Identifier: GPL-3.0-or-later
// Sections of a volume.
#include <algorithm>
#include <utility>

#include "plot/private/insert_shadows.hpp"
#include "plot/private/view_parts.hpp"
#include "plot/view.hpp"

namespace vam::plot {

namespace {

bool is_coverage(const std::string& grid) { return grid == "target" || grid == "insert" || grid == "weight"; }

void add_insert(ImageFigure& figure, const io::SparseVolume& insert, Plane plane, const std::vector<int>& indices) {
  std::vector<Image> hidden = planes(insert, plane, indices), shadows = insert_shadows(insert, plane, indices);
  for (std::size_t n = 0; n < hidden.size(); ++n) {
    figure.panels[n].hatched = std::move(hidden[n]);
    figure.panels[n].shaded = std::move(shadows[n]);
  }
  figure.hatched_name = "insert";
  const auto is_shaded = [](const Panel& panel) {
    return std::any_of(panel.shaded.values.begin(), panel.shaded.values.end(), [](float share) { return share > 0; });
  };
  if (!std::any_of(figure.panels.begin(), figure.panels.end(), is_shaded)) return;
  figure.legend.push_back({Mark::patch, paint::orange, "its shadow, deeper where it hides more stage angles"});
}

}  // namespace

ImageFigure view_volume(const io::SparseVolume& volume, const io::SparseVolume* target, const ViewOptions& options,
                        const io::SparseVolume* insert) {
  const model::Grid& grid = volume.grid();
  const views::Sections sections = views::sections_of(grid, options);
  std::vector<Image> images = planes(volume, options.plane, sections.indices);
  ImageFigure figure;
  for (std::size_t n = 0; n < images.size(); ++n)
    figure.panels.push_back({std::move(images[n]), sections.captions[n], {}});
  if (target != nullptr) views::add_outlines(figure, *target, grid, options.plane, sections);
  if (insert != nullptr) add_insert(figure, *insert, options.plane, sections.indices);
  const bool coverage = is_coverage(volume.name());
  views::choose_colours(figure, options, coverage ? views::Content::coverage : views::Content::amount);
  views::set_section_axes(figure, grid, options);
  figure.scale.label = coverage ? volume.name() + " (covered fraction)" : views::with_unit(volume.name(), volume.units);
  figure.scale.mark = options.critical;
  figure.title =
      options.title.value_or(options.name + ": " + volume.name() + views::sections_text(sections, options.plane));
  return figure;
}

}  // namespace vam::plot
