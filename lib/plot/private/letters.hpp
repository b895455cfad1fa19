// SPDX-License-Identifier: GPL-3.0-or-later
// A line of text as pango lays it out, in the sans-serif font of the machine.
#pragma once

#include <memory>
#include <string>

#include "plot/private/cairo_library.hpp"

namespace vam::plot {

inline constexpr double capital_height = 0.73;  // of the size, in the fonts of DejaVu and Liberation

class Letters {
 public:
  Letters(const std::string& words, double size);

  [[nodiscard]] double width() const;
  [[nodiscard]] double baseline() const;  // from the top of the layout
  /// With its upper left corner at the current point.
  void show(cairo_t* context) const;

 private:
  std::unique_ptr<PangoLayout, void (*)(void*)> layout_;
};

}  // namespace vam::plot
