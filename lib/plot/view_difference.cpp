// SPDX-License-Identifier: GPL-3.0-or-later
// Two volumes beside each other, and their difference.
#include "base/error.hpp"
#include "model/grid_place.hpp"
#include "model/grid_size.hpp"
#include "plot/private/view_parts.hpp"
#include "plot/view.hpp"

namespace vam::plot {

namespace {

Image difference(const Image& from, const Image& to) {
  Image result = to;
  for (std::size_t i = 0; i < result.size(); ++i) result.values[i] -= from.values[i];
  return result;
}

std::vector<const Image*> pointers(const std::vector<Image>& first, const std::vector<Image>& second) {
  std::vector<const Image*> all;
  for (const Image& image : first) all.push_back(&image);
  for (const Image& image : second) all.push_back(&image);
  return all;
}

}  // namespace

void require_same_voxels(const model::Grid& grid, const model::Grid& other, const std::string& name,
                         const std::string& remedy) {
  if (model::same_voxels(grid, other)) return;
  throw Error{Fault::data, name + ": has " + model::place_text(grid) + ", but the other volume has " +
                               model::place_text(other) + "; " + remedy};
}

ImageFigure view_difference(const io::SparseVolume& volume, const io::SparseVolume& other,
                            const std::string& other_name, const ViewOptions& options) {
  require_same_voxels(volume.grid(), other.grid(), options.name, "compare volumes of one grid");
  const views::Sections sections = views::sections_of(volume.grid(), options);
  const std::vector<Image> first = planes(volume, options.plane, sections.indices);
  const std::vector<Image> second = planes(other, options.plane, sections.indices);
  std::vector<Image> differences;
  for (std::size_t n = 0; n < first.size(); ++n) differences.push_back(difference(first[n], second[n]));
  ColourScale both = views::scale_for(pointers(first, second), options, views::Content::amount);
  both.label = views::with_unit(volume.name(), volume.units);
  ViewOptions signed_options = options;
  signed_options.low = signed_options.high = std::nullopt;
  signed_options.colours = "diverging";
  ColourScale change = views::scale_for(pointers(differences, {}), signed_options, views::Content::amount);
  change.label = views::with_unit("difference", volume.units);
  ImageFigure figure;
  for (std::size_t n = 0; n < first.size(); ++n) {
    const std::string place = sections.captions.size() > 1 ? ", " + sections.captions[n] : "";
    figure.panels.push_back({first[n], options.name + place, {}});
    figure.panels.back().scale = both;
    figure.panels.push_back({second[n], other_name + place, {}});
    figure.panels.back().scale = both;
    figure.panels.push_back({differences[n], "second minus first" + place, {}});
    figure.panels.back().scale = change;
  }
  figure.columns = 3;
  views::set_section_axes(figure, volume.grid(), options);
  figure.title = options.title.value_or(options.name + " and " + other_name + ": " + volume.name() +
                                        views::sections_text(sections, options.plane));
  return figure;
}

}  // namespace vam::plot
