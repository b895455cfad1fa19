// SPDX-License-Identifier: GPL-3.0-or-later
// A page for a browser: one file with its images within, readable without a network. Text from outside is escaped.
#pragma once

#include <string>

#include "base/pixels.hpp"
#include "plot/colour_map.hpp"
#include "plot/plot.hpp"

namespace vam::plot {

/// The bytes of a PNG, in at most 256 colours, as base64.
[[nodiscard]] std::string page_png(const RgbImage& image);

/// <img> with the PNG within.
[[nodiscard]] std::string page_image(const RgbImage& image, const std::string& alt);

/// A plot as such an image, small: its words are read in the columns of a page, and on a telephone.
[[nodiscard]] std::string page_plot(Plot plot, const std::string& alt);

/// CSS: a gradient to the right over all colours of the map, by so many steps.
[[nodiscard]] std::string page_gradient(ColourMap map, int steps);

/// <figure> with heading and caption around `content`, which is HTML; the other two are text.
[[nodiscard]] std::string page_figure(const std::string& title, const std::string& content, const std::string& caption);

struct Page {
  std::string title;            // text
  std::string head;             // HTML: further elements of the head
  std::string body_attributes;  // HTML: `data-live="1"`
  std::string body;             // HTML
  std::string style;            // CSS beside that of all pages
  std::string script;           // JavaScript, at the end of the body: nothing else can run
};

/// UTF-8. The content security policy allows images within the page, styles and this script, which is bound by its
/// hash; there is no access to any network.
[[nodiscard]] std::string html(const Page& page);

}  // namespace vam::plot
