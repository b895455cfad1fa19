// SPDX-License-Identifier: GPL-3.0-or-later
// Where a dose cures the part, where not, and where too much.
#include <array>
#include <utility>
#include <vector>

#include "base/text/text.hpp"
#include "model/dose/dose_metrics.hpp"
#include "plot/missing.hpp"
#include "plot/private/view_parts.hpp"
#include "plot/view.hpp"

namespace vam::plot {

namespace {

enum Cure : std::size_t { empty, cured, missing, overcured, cut_missing, cut_overcured };

constexpr std::array<Rgb, 6> colours{paint::white,     Rgb{150, 150, 150}, paint::blue,
                                     paint::vermilion, Rgb{150, 200, 235}, Rgb{245, 190, 140}};

/// `share`: of the part that is missing.
Cure cure_of(float dose, float coverage, float share, double threshold) {
  if (share > 0) return missing;
  const bool printed = static_cast<double>(dose) >= threshold;
  if (model::label_of(coverage) == model::Label::void_) return printed ? overcured : empty;
  if (printed) return model::half_covered(coverage) ? cured : cut_overcured;
  return model::half_covered(coverage) ? cut_missing : empty;
}

/// What is seen: of the part its volume, of the judged void its voxels, and how they cure.
struct Counts {
  double part = 0;
  double outside = 0;
  double missing = 0;
  double overcured = 0;
  double cut_missing = 0;
  double cut_overcured = 0;

  void add(model::Label label, float coverage, float share, Cure cure) {
    part += label == model::Label::void_ ? 0 : static_cast<double>(coverage);
    outside += label == model::Label::void_ ? 1 : 0;
    missing += static_cast<double>(share);
    overcured += cure == Cure::overcured ? 1 : 0;
    cut_missing += cure == Cure::cut_missing ? static_cast<double>(coverage) : 0;
    cut_overcured += cure == Cure::cut_overcured ? static_cast<double>(1 - coverage) : 0;
  }
};

/// "missing (0.3 % of the part seen)".
std::string with_share(const std::string& what, double count, double of, const std::string& whole) {
  const double percent = of > 0 ? 100 * count / of : 0;
  return what + " (" + format_number(percent, 3) + " % of the " + whole + " seen)";
}

// Voxels that the surface cuts are only named where some are wrong: few prints are right to half a voxel.
std::vector<LegendEntry> legend_of(const Counts& counts, bool insert) {
  std::vector<LegendEntry> entries{
      {Mark::patch, colours[cured], "cured"},
      {Mark::patch, colours[missing], with_share("missing", counts.missing, counts.part, "part")},
      {Mark::patch, colours[overcured], with_share("overcured", counts.overcured, counts.outside, "void")}};
  if (counts.cut_missing > 0)
    entries.push_back({Mark::patch, colours[cut_missing],
                       with_share("missing in voxels that the surface cuts", counts.cut_missing, counts.part, "part")});
  if (counts.cut_overcured > 0)
    entries.push_back(
        {Mark::patch, colours[cut_overcured],
         with_share("overcured in voxels that the surface cuts", counts.cut_overcured, counts.outside, "void")});
  entries.push_back({Mark::none,
                     {},
                     insert ? "the insert, and void beyond the writable circle, are not counted"
                            : "void beyond the writable circle is not counted"});
  return entries;
}

}  // namespace

ImageFigure view_cure(const io::SparseVolume& dose, const io::SparseVolume& target, double threshold,
                      const model::Circle& circle, const ViewOptions& options, const io::SparseVolume* insert) {
  require_same_voxels(dose.grid(), target.grid(), options.name, "compute the dose on this target");
  const MissingPart lacking = missing_part(dose, target, threshold);
  ViewOptions seen = options;
  if (!seen.at && seen.sheet == 1)
    seen.at = plane_mm(dose.grid(), seen.plane, lacking.section(seen.plane)) /
              (seen.plane == Plane::axial ? seen.stretch_z : 1);
  const views::Sections sections = views::sections_of(dose.grid(), seen);
  std::vector<Image> doses = planes(dose, options.plane, sections.indices);
  const std::vector<Image> parts = planes(target, options.plane, sections.indices);
  const std::vector<Image> shares = planes(lacking.shares, options.plane, sections.indices);
  ImageFigure figure;
  Counts counts;
  std::vector<Image> hidden;
  if (insert != nullptr) hidden = planes(*insert, options.plane, sections.indices);
  for (std::size_t n = 0; n < doses.size(); ++n) {
    RgbImage picture(doses[n].width, doses[n].height);
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const model::Label label = model::label_of(parts[n](x, y));
        const Cure cure = cure_of(doses[n](x, y), parts[n](x, y), shares[n](x, y), threshold);
        picture(x, y) = colours[cure];
        const auto [i, j] = plane_column(dose.grid(), options.plane, sections.indices[n], x, y);
        if (!hidden.empty() && model::half_covered(hidden[n](x, y))) continue;
        if (label != model::Label::void_ || circle.contains(i, j))
          counts.add(label, parts[n](x, y), shares[n](x, y), cure);
      }
    }
    figure.panels.push_back({std::move(doses[n]), sections.captions[n], {}});
    figure.panels.back().picture = std::move(picture);
  }
  views::add_outlines(figure, target, dose.grid(), options.plane, sections);
  if (insert != nullptr) {
    for (std::size_t n = 0; n < hidden.size(); ++n) figure.panels[n].hatched = std::move(hidden[n]);
    figure.hatched_name = "insert";
  }
  views::set_section_axes(figure, dose.grid(), options);
  figure.legend = legend_of(counts, insert != nullptr);
  figure.title = options.title.value_or(options.name + ": cured at " + format_number(threshold, 4) + " " + dose.units +
                                        views::sections_text(sections, options.plane));
  return figure;
}

}  // namespace vam::plot
