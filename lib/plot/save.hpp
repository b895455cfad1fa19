// SPDX-License-Identifier: GPL-3.0-or-later
// Figures as files.
#pragma once

#include <string>
#include <vector>

#include "plot/canvas.hpp"

namespace vam::plot {

/// The endings of figures: .png, .pdf, .svg.
[[nodiscard]] const std::vector<std::string>& figure_endings();
[[nodiscard]] bool is_figure(const std::string& path);

/// Throws Fault::absent where cairo and pango are not installed: for the beginning of long work that ends in a figure.
void require_figures();

/// By the ending of the name; PNG where there is none, and to "-". The density is that of a PNG; `history` goes into
/// the file. Throws Error: no_output, io; absent, where cairo and pango are not installed.
void save(const std::string& path, const Canvas& figure, const std::string& history = "", double dpi = screen_dpi);

}  // namespace vam::plot
