// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the views: what figures of volumes, stacks and doses share.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "base/pixels.hpp"
#include "plot/view.hpp"

namespace vam::plot::views {

struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(float value) {
    low = std::min(low, static_cast<double>(value));
    high = std::max(high, static_cast<double>(value));
  }
};

/// Indices of `wanted` of `count` things, evenly spread, the outer ones half a step from the ends.
[[nodiscard]] std::vector<int> spread(int count, int wanted);

/// Signed values get the diverging colours with zero in the middle; coverage and light are grey; amounts viridis. The
/// ends are exceeded by one value in a thousand at most, or are 0 and 1 for coverage.
enum class Content { amount, light, coverage };
[[nodiscard]] ColourScale scale_for(const std::vector<const Image*>& images, const ViewOptions& options,
                                    Content content);
/// Gives the panels one scale; values beyond its ends are reported in the legend.
void choose_colours(ImageFigure& figure, const ViewOptions& options, Content content);

/// What sections of a volume are seen, at `at` or spread over it.
struct Sections {
  std::vector<int> indices;
  std::vector<double> places_mm;
  std::vector<std::string> captions;  // "z = 1.5 mm"
};
/// Throws Fault::data where the volume has none at `at`.
[[nodiscard]] Sections sections_of(const model::Grid& grid, const ViewOptions& options);
/// Once the panels are there.
void set_section_axes(ImageFigure& figure, const model::Grid& grid, const ViewOptions& options);
/// The target's surface on each of them, of as many panels as there are to a section.
void add_outlines(ImageFigure& figure, const io::SparseVolume& target, const model::Grid& grid, Plane plane,
                  const Sections& sections);
/// Leaves of all panels that part.
void crop(ImageFigure& figure, const PixelRect& part);
/// ", axial section at z = 1.5 mm", or ", axial sections".
[[nodiscard]] std::string sections_text(const Sections& sections, Plane plane);

/// "dose (mJ/cm3)"
[[nodiscard]] std::string with_unit(const std::string& what, const std::string& unit);
/// "1.5 mm"
[[nodiscard]] std::string mm(double value);

}  // namespace vam::plot::views
