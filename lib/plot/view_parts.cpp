#include "plot/private/view_parts.hpp"

#include <cmath>

#include "base/text.hpp"

namespace vam::plot::views {

std::vector<int> spread(int count, int wanted) {
  std::vector<int> indices;
  const int shown = std::clamp(wanted, 1, count);
  for (int n = 0; n < shown; ++n) indices.push_back(static_cast<int>((n + 0.5) * count / shown));
  return indices;
}

void choose_colours(ImageFigure& figure, const ViewOptions& options, Extremes found, bool grey) {
  const bool is_signed = found.low < -1e-3 * std::abs(found.high);
  std::string colours = options.colours;
  if (colours == "auto") colours = is_signed ? "diverging" : grey ? "grey" : "viridis";
  figure.scale.map = colours == "diverging" ? ColourMap::diverging
                     : colours == "grey"    ? ColourMap::grey
                                            : ColourMap::viridis;
  const double reach = std::max(std::abs(found.low), std::abs(found.high));
  const bool diverging = figure.scale.map == ColourMap::diverging;
  figure.scale.low = options.low.value_or(diverging ? -reach : std::min(0.0, found.low));
  figure.scale.high = options.high.value_or(diverging ? reach : found.high);
  if (!(figure.scale.high > figure.scale.low)) figure.scale.high = figure.scale.low + 1;
}

std::string with_unit(const std::string& what, const std::string& unit) {
  std::string shown = unit;
  if (shown.ends_with("cm3")) shown.replace(shown.size() - 1, 1, "³");
  if (shown.ends_with("cm2")) shown.replace(shown.size() - 1, 1, "²");
  return what + " (" + shown + ")";
}

std::string mm(double value) { return format_number(std::abs(value) < 1e-9 ? 0 : value, 4) + " mm"; }

}  // namespace vam::plot::views
