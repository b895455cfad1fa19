// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-view/trace.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "io/settings/csv_table.hpp"
#include "plot/convergence.hpp"

namespace vam::view_tool {

namespace {

std::vector<double> column_of(const io::CsvTable& table, std::size_t column) {
  std::vector<double> values;
  for (std::size_t row = 0; row < table.rows.size(); ++row) values.push_back(table.number(row, column));
  return values;
}

plot::Trace read_trace(const std::string& path, const std::string& name) {
  const io::CsvTable table = io::read_csv(path, {"iteration", "ver", "pw"});
  return {name, column_of(table, 0), column_of(table, 1), column_of(table, 2)};
}

plot::Plot convergence_plot(const Options& options) {
  const bool two = !options.compare.empty();
  std::vector<plot::Trace> traces{read_trace(options.input, two ? file_name(options.input) : "")};
  if (two) traces.push_back(read_trace(options.compare, file_name(options.compare)));
  plot::Plot plot = plot::convergence(traces);
  plot.title = options.view.title.value_or(options.view.name + ": convergence");
  return plot;
}

/// "closed_loop_mm" is the curve "closed loop" in mm: the last word of a column's name is its unit if others have it,
/// too.
std::string unit_of(const std::vector<std::string>& columns) {
  const auto last = [](const std::string& name) {
    const auto at = name.rfind('_');
    return at == std::string::npos || at == 0 ? std::string() : name.substr(at + 1);
  };
  const std::string unit = last(columns[1]);
  const bool shared = std::all_of(columns.begin() + 1, columns.end(),
                                  [&](const std::string& name) { return !unit.empty() && last(name) == unit; });
  return shared ? unit : std::string();
}

std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// The further columns over the first one.
plot::Plot table_plot(const io::CsvTable& table, const Options& options) {
  constexpr std::array colours{plot::paint::blue, plot::paint::vermilion, plot::paint::green, plot::paint::orange};
  if (table.columns.size() < 2 || table.columns.size() > colours.size() + 1) {
    throw Error{Fault::data, table.source + ": has " + std::to_string(table.columns.size()) +
                                 " columns; 1 to 4 are drawn as curves over the first one"};
  }
  const std::string unit = unit_of(table.columns);
  plot::Plot plot;
  plot.title = options.view.title.value_or(options.view.name);
  plot.x.label = words(table.columns[0]);
  plot.y.label = unit.empty() ? std::string() : unit;
  const std::vector<double> x = column_of(table, 0);
  for (std::size_t n = 1; n < table.columns.size(); ++n) {
    std::string name = table.columns[n];
    if (!unit.empty()) name.resize(name.size() - unit.size() - 1);
    plot.series.push_back({words(std::move(name)), x, column_of(table, n), colours[n - 1], plot::SeriesStyle::line});
  }
  return plot;
}

}  // namespace

plot::Plot trace_plot(const Options& options) {
  const io::CsvTable table = io::read_csv(options.input, {});
  if (table.columns.front() == "iteration") return convergence_plot(options);
  if (!options.compare.empty()) {
    throw Error{Fault::data, table.source + ": --compare does not apply to a table that is no trace"};
  }
  return table_plot(table, options);
}

}  // namespace vam::view_tool
