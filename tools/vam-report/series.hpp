// SPDX-License-Identifier: GPL-3.0-or-later
// Images of which one is seen at a time: a slider moves through them.
#pragma once

#include <string>
#include <vector>

#include "base/pixels.hpp"
#include "plot/image_figure.hpp"

namespace vam::report_tool {

struct Frame {
  std::string label;  // "z = 1.5 mm"
  RgbImage image;
};

/// HTML. The middle one is seen first, and printed. With `plays` there is a button that shows one after the other.
[[nodiscard]] std::string series(const std::string& title, const std::vector<Frame>& frames, const std::string& caption,
                                 bool plays = false);

/// Each panel of a sheet as a figure with axes, in the colours of all of them.
[[nodiscard]] std::vector<Frame> frames_of(const plot::ImageFigure& sheet);

}  // namespace vam::report_tool
