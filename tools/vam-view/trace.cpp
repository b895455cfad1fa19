// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-view/trace.hpp"

#include <string>

#include "io/settings/csv_table.hpp"
#include "plot/convergence.hpp"

namespace vam::view_tool {

namespace {

plot::Trace read_trace(const std::string& path, const std::string& name) {
  const io::CsvTable table = io::read_csv(path, {"iteration", "ver", "pw"});
  plot::Trace trace{name, {}, {}, {}};
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    trace.iteration.push_back(table.number(row, 0));
    trace.ver.push_back(table.number(row, 1));
    trace.window.push_back(table.number(row, 2));
  }
  return trace;
}

}  // namespace

plot::Plot trace_plot(const Options& options) {
  const bool two = !options.compare.empty();
  std::vector<plot::Trace> traces{read_trace(options.input, two ? file_name(options.input) : "")};
  if (two) traces.push_back(read_trace(options.compare, file_name(options.compare)));
  plot::Plot plot = plot::convergence(traces);
  plot.title = options.view.title.value_or(options.view.name + ": convergence");
  return plot;
}

}  // namespace vam::view_tool
