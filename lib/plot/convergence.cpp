// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/convergence.hpp"

#include <array>

namespace vam::plot {

Plot convergence(const std::vector<Trace>& traces) {
  constexpr std::array<std::array<Rgb, 2>, 2> colours{{{paint::blue, paint::vermilion}, {paint::green, paint::orange}}};
  Plot curves;
  curves.x.label = "iteration";
  curves.x.whole = true;
  curves.y.label = "VER, process window / largest dose";
  for (std::size_t n = 0; n < traces.size(); ++n) {
    const Trace& trace = traces[n];
    const std::string name = trace.name.empty() ? "" : trace.name + ": ";
    const auto& [window, errors] = colours[n % colours.size()];
    curves.series.push_back({name + "process window", trace.iteration, trace.window, window, SeriesStyle::line});
    curves.series.push_back({name + "VER", trace.iteration, trace.ver, errors, SeriesStyle::line});
  }
  return curves;
}

}  // namespace vam::plot
