// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/private/view_parts.hpp"

#include <cmath>
#include <cstddef>

#include "base/text/text.hpp"

namespace vam::plot::views {

std::vector<int> spread(int count, int wanted) {
  std::vector<int> indices;
  const int shown = std::clamp(wanted, 1, count);
  for (int n = 0; n < shown; ++n) indices.push_back(static_cast<int>((n + 0.5) * count / shown));
  return indices;
}

namespace {

constexpr double beyond = 0.001;  // share of the values that may lie beyond either end

std::vector<float> values_of(const std::vector<const Image*>& images) {
  std::vector<float> all;
  for (const Image* image : images) all.insert(all.end(), image->values.begin(), image->values.end());
  return all;
}

double quantile(std::vector<float>& values, double share) {
  const double place = share * (static_cast<double>(values.size()) - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share < 0.5 ? std::floor(place) : std::ceil(place));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

ColourMap map_for(const ViewOptions& options, Content content, bool is_signed) {
  if (options.colours == "diverging") return ColourMap::diverging;
  if (options.colours == "grey") return ColourMap::grey;
  if (options.colours == "viridis") return ColourMap::viridis;
  if (is_signed) return ColourMap::diverging;
  return content == Content::amount ? ColourMap::viridis : ColourMap::grey;
}

std::string clipped(double share, const std::string& where, double end, double extreme) {
  return format_number(100 * share, 2) + " % of the pixels are " + where + " " + format_number(end, 3) + " (to " +
         format_number(extreme, 3) + ")";
}

}  // namespace

ColourScale scale_for(const std::vector<const Image*>& images, const ViewOptions& options, Content content) {
  std::vector<float> all = values_of(images);
  double low = quantile(all, beyond);
  double high = quantile(all, 1 - beyond);
  const auto [least, most] = std::minmax_element(all.begin(), all.end());
  if (high <= std::min(low, 0.0)) high = static_cast<double>(*most);  // little is lit
  if (low > high) low = static_cast<double>(*least);
  ColourScale scale;
  scale.map = map_for(options, content, static_cast<double>(*least) < -1e-3 * std::abs(static_cast<double>(*most)));
  if (content == Content::coverage) low = std::min(0.0, low), high = std::max(1.0, high);
  const double reach = std::max(std::abs(low), std::abs(high));
  const bool diverging = scale.map == ColourMap::diverging;
  scale.low = options.low.value_or(diverging ? -reach : std::min(0.0, low));
  scale.high = options.high.value_or(diverging ? reach : high);
  if (!(scale.high > scale.low)) scale = {scale.map, scale.low - (diverging ? 1 : 0), scale.low + 1, ""};
  return scale;
}

void choose_colours(ImageFigure& figure, const ViewOptions& options, Content content) {
  std::vector<const Image*> images;
  for (const Panel& panel : figure.panels) images.push_back(&panel.values);
  figure.scale = scale_for(images, options, content);
  const std::vector<float> all = values_of(images);
  const auto [least, most] = std::minmax_element(all.begin(), all.end());
  const double low = figure.scale.low - 1e-6 * std::abs(figure.scale.low);
  const double high = figure.scale.high + 1e-6 * std::abs(figure.scale.high);
  const auto share = [&](auto is_beyond) {
    return static_cast<double>(std::count_if(all.begin(), all.end(), is_beyond)) / static_cast<double>(all.size());
  };
  const double above = share([&](float value) { return static_cast<double>(value) > high; });
  const double below = share([&](float value) { return static_cast<double>(value) < low; });
  if (above > 0)
    figure.legend.push_back({Mark::none, {}, clipped(above, "above", figure.scale.high, static_cast<double>(*most))});
  if (below > 0)
    figure.legend.push_back({Mark::none, {}, clipped(below, "below", figure.scale.low, static_cast<double>(*least))});
}

std::string with_unit(const std::string& what, const std::string& unit) {
  std::string shown = unit;
  if (shown.ends_with("cm3")) shown.replace(shown.size() - 1, 1, "³");
  if (shown.ends_with("cm2")) shown.replace(shown.size() - 1, 1, "²");
  return what + " (" + shown + ")";
}

std::string mm(double value) { return format_number(std::abs(value) < 1e-9 ? 0 : value, 4) + " mm"; }

}  // namespace vam::plot::views
