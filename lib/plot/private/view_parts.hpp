// Private to the views: what figures of volumes, stacks and doses share.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "plot/view.hpp"

namespace vam::plot::views {

struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(float value) {
    low = std::min(low, static_cast<double>(value));
    high = std::max(high, static_cast<double>(value));
  }
  void add(const Image& image) {
    for (const float value : image.values) add(value);
  }
};

/// Indices of `wanted` of `count` things, evenly spread, the outer ones half a step from the ends.
[[nodiscard]] std::vector<int> spread(int count, int wanted);

/// Signed values get the diverging colours with zero in the middle; coverage and light are grey; amounts viridis.
void choose_colours(ImageFigure& figure, const ViewOptions& options, Extremes found, bool grey);

/// "dose (mJ/cm3)"
[[nodiscard]] std::string with_unit(const std::string& what, const std::string& unit);
/// "1.5 mm"
[[nodiscard]] std::string mm(double value);

}  // namespace vam::plot::views
