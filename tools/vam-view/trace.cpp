// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "io/settings/csv_table.hpp"
#include "plot/curves.hpp"
#include "vam-view/figures.hpp"

namespace vam::view_tool {

namespace {

plot::Trace read_trace(const std::string& path, const std::string& name) {
  const io::CsvTable table = io::read_csv(path, {"iteration", "ver", "pw"});
  return {name, table.column(0), table.column(1), table.column(2)};
}

plot::Plot convergence_plot(const Options& options) {
  const std::vector<std::string> names = file_names(options);
  std::vector<plot::Trace> traces{read_trace(options.input, names.size() > 1 ? names[0] : "")};
  for (const std::string& path : options.compare) traces.push_back(read_trace(path, names[traces.size()]));
  plot::Plot plot = plot::convergence(traces);
  plot.title = options.view.title.value_or(options.view.name + ": convergence");
  return plot;
}

/// A unit that the names of all columns but the first end in, as in open_loop_mm,closed_loop_mm.
struct Unit {
  std::string ending;
  std::string shown;
};

std::optional<Unit> unit_of(const std::vector<std::string>& columns) {
  static const std::vector<Unit> units{
      {"_mj_cm3", "mJ/cm3"}, {"_mj_cm2", "mJ/cm2"}, {"_mw_cm2", "mW/cm2"}, {"_mm", "mm"}, {"_um", "um"},
      {"_px", "px"},         {"_deg", "deg"},       {"_ms", "ms"},         {"_s", "s"},   {"_percent", "%"}};
  for (const Unit& unit : units) {
    const auto has = [&](const std::string& name) {
      return name.size() > unit.ending.size() && name.ends_with(unit.ending);
    };
    if (std::all_of(columns.begin() + 1, columns.end(), has)) return unit;
  }
  return std::nullopt;
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
  const std::optional<Unit> unit = unit_of(table.columns);
  plot::Plot plot;
  plot.title = options.view.title.value_or(options.view.name);
  plot.x.label = words(table.columns[0]);
  plot.y.label = unit ? unit->shown : "";
  const std::vector<double> x = table.column(0);
  for (std::size_t n = 1; n < table.columns.size(); ++n) {
    std::string name = table.columns[n];
    if (unit) name.resize(name.size() - unit->ending.size());
    plot.series.push_back({words(std::move(name)), x, table.column(n), colours[n - 1], plot::SeriesStyle::line});
  }
  return plot;
}

}  // namespace

plot::Plot trace_plot(const Options& options) {
  const io::CsvTable table = io::read_csv(options.input, {});
  const auto& names = table.columns;
  const auto has = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  if (has("iteration") && has("ver") && has("pw")) return convergence_plot(options);
  if (!options.compare.empty()) {
    throw Error{Fault::data, table.source + ": --compare does not apply to a table that is no trace"};
  }
  return table_plot(table, options);
}

}  // namespace vam::view_tool
