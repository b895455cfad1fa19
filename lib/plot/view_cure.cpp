// Where a dose cures the part, where not, and where too much.
#include <array>

#include "base/text.hpp"
#include "model/dose_metrics.hpp"
#include "plot/private/view_parts.hpp"
#include "plot/view.hpp"

namespace vam::plot {

namespace {

enum Cure : std::size_t { empty, cured, missing, overcured };

constexpr std::array<Rgb, 4> colours{paint::white, Rgb{150, 150, 150}, paint::blue, paint::vermilion};

Cure cure_of(float dose, float covered, double threshold) {
  const bool printed = static_cast<double>(dose) >= threshold;
  const model::Label label = model::label_of(covered);
  if (label == model::Label::part) return printed ? cured : missing;
  if (label == model::Label::void_) return printed ? overcured : empty;
  return printed ? cured : empty;
}

/// "missing: 0.3 % of the part".
std::string with_share(const std::string& what, long count, long of, const std::string& whole) {
  const double percent = of > 0 ? 100 * static_cast<double>(count) / static_cast<double>(of) : 0;
  return what + " (" + format_number(percent, 3) + " % of the " + whole + ")";
}

}  // namespace

ImageFigure view_cure(const io::SparseVolume& dose, const io::SparseVolume& target, double threshold,
                      const ViewOptions& options) {
  require_same_voxels(dose.grid(), target.grid(), options.name, "compute the dose on this target");
  const views::Sections sections = views::sections_of(dose.grid(), options);
  std::vector<Image> doses = planes(dose, options.plane, sections.indices);
  const std::vector<Image> parts = planes(target, options.plane, sections.indices);
  ImageFigure figure;
  std::array<long, 4> counts{};
  long part = 0;
  long outside = 0;
  for (std::size_t n = 0; n < doses.size(); ++n) {
    RgbImage picture(doses[n].width, doses[n].height);
    for (std::size_t i = 0; i < doses[n].size(); ++i) {
      const Cure cure = cure_of(doses[n].values[i], parts[n].values[i], threshold);
      picture.values[i] = colours[cure];
      ++counts[cure];
      const model::Label label = model::label_of(parts[n].values[i]);
      part += label == model::Label::part ? 1 : 0;
      outside += label == model::Label::void_ ? 1 : 0;
    }
    figure.panels.push_back({std::move(doses[n]), sections.captions[n], {}});
    figure.panels.back().picture = std::move(picture);
  }
  const auto lines = outlines(target, dose.grid(), options.plane, sections.places_mm);
  for (std::size_t n = 0; n < lines.size(); ++n) figure.panels[n].outline = lines[n];
  views::set_section_axes(figure, dose.grid(), options);
  figure.outline_name = "surface of the target";
  figure.legend = {{Mark::patch, colours[cured], "cured"},
                   {Mark::patch, colours[missing], with_share("missing", counts[missing], part, "part seen")},
                   {Mark::patch, colours[overcured], with_share("overcured", counts[overcured], outside, "void seen")},
                   {Mark::none, {}, "voxels that the surface cuts are not judged"}};
  figure.title = options.title.value_or(options.name + ": cured at " + format_number(threshold, 4) + " " + dose.units +
                                        views::sections_text(sections, options.plane));
  return figure;
}

}  // namespace vam::plot
