// SPDX-License-Identifier: GPL-3.0-or-later
// Two volumes beside each other, and their difference.
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
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

std::vector<const Image*> pointers(const std::vector<std::vector<Image>>& volumes) {
  std::vector<const Image*> all;
  for (const auto& images : volumes)
    for (const Image& image : images) all.push_back(&image);
  return all;
}

}  // namespace

void require_same_voxels(const model::Grid& grid, const model::Grid& other, const std::string& name,
                         const std::string& remedy) {
  if (model::same_voxels(grid, other)) return;
  throw Error{Fault::data, name + ": has " + model::place_text(grid) + ", but the other volume has " +
                               model::place_text(other) + "; " + remedy};
}

ImageFigure view_difference(const io::SparseVolume& volume, const std::vector<OtherVolume>& others,
                            const io::SparseVolume* target, const ViewOptions& options) {
  const views::Sections sections = views::sections_of(volume.grid(), options);
  std::vector<std::vector<Image>> seen{planes(volume, options.plane, sections.indices)};
  std::vector<std::vector<Image>> differences;
  std::vector<std::string> names{options.name};
  for (const OtherVolume& other : others) {
    require_same_voxels(volume.grid(), other.volume->grid(), options.name, "compare volumes of one grid");
    names.push_back(other.name);
    seen.push_back(planes(*other.volume, options.plane, sections.indices));
    std::vector<Image>& change = differences.emplace_back();
    for (std::size_t n = 0; n < seen[0].size(); ++n) change.push_back(difference(seen[0][n], seen.back()[n]));
  }
  ColourScale all = views::scale_for(pointers(seen), options, views::Content::amount);
  all.label = views::with_unit(volume.name(), volume.units);
  ViewOptions signed_options = options;
  signed_options.low = signed_options.high = std::nullopt;
  signed_options.colours = "diverging";
  ColourScale change = views::scale_for(pointers(differences), signed_options, views::Content::amount);
  change.label = views::with_unit("difference", volume.units);
  ImageFigure figure;
  for (std::size_t n = 0; n < sections.indices.size(); ++n) {
    const std::string place = sections.captions.size() > 1 ? ", " + sections.captions[n] : "";
    const auto show = [&](const Image& image, const std::string& name, const ColourScale& scale) {
      figure.panels.push_back({image, name + place, {}});
      figure.panels.back().scale = scale;
    };
    for (std::size_t v = 0; v < seen.size(); ++v) show(seen[v][n], names[v], all);
    for (std::size_t v = 0; v < differences.size(); ++v)
      show(differences[v][n], others.size() == 1 ? "second minus first" : names[v + 1] + " minus first", change);
  }
  figure.columns = count_of(seen) + count_of(differences);
  if (target != nullptr) views::add_outlines(figure, *target, volume.grid(), options.plane, sections);
  views::set_section_axes(figure, volume.grid(), options);
  figure.title = options.title.value_or(join(names, " and ") + ": " + volume.name() +
                                        views::sections_text(sections, options.plane));
  return figure;
}

}  // namespace vam::plot
