// SPDX-License-Identifier: GPL-3.0-or-later
// vam-sdf trend: what repeated prints do to the figures.
#include "metrology/compare/trend.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "plot/plot.hpp"
#include "plot/save.hpp"
#include "vam-sdf/options.hpp"

namespace vam::sdf_tool {

namespace {

struct Series {
  std::vector<double> values;
  std::vector<double> uncertainties;
};
using AllSeries = std::map<std::string, Series>;

bool is_inspection(const Json& report) { return is_of(report, "vam-sdf") && report.contains("expanded_uncertainty"); }

// The folder of a run means the report in it.
std::string report_in(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return path;
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    const std::string name = entry.path().string();
    if (name.ends_with(".json") && is_inspection(parse_json(io::read_all(name)))) found.push_back(name);
  }
  if (found.size() == 1) return found.front();
  throw Error{Fault::data,
              path + ": holds " + std::to_string(found.size()) + " reports of vam-sdf; a run has one, give the file"};
}

void add(AllSeries& all, const std::string& prefix, const Json& figures, const Json& uncertainty) {
  for (const auto& [key, value] : uncertainty.items()) {
    if (!figures.contains(key)) continue;
    const Json& is = figures.at(key);
    if (value.is_object()) add(all, prefix + key + ".", is, value);
    if (!value.is_number() || !is.is_number()) continue;
    all[prefix + key].values.push_back(is.get<double>());
    all[prefix + key].uncertainties.push_back(value.get<double>());
  }
}

AllSeries read_series(const std::vector<std::string>& runs) {
  constexpr std::size_t fewest = 3;
  if (runs.size() < fewest) throw Error{Fault::usage, "RUN: a trend needs at least 3 prints"};
  AllSeries all;
  for (const std::string& run : runs) {
    const std::string path = report_in(run);
    const Json report = parse_distinct(io::read_all(path), path);
    if (!is_inspection(report)) {
      throw Error{Fault::data, path + ": is not a report of vam-sdf with uncertainties; measure the print anew"};
    }
    (void)io::require_seal(report, path);
    add(all, "", report, report.at("expanded_uncertainty"));
  }
  std::erase_if(all, [&](const auto& item) { return item.second.values.size() != runs.size(); });
  return all;
}

void draw(const std::string& path, const std::string& name, const Series& series) {
  plot::Plot plot;
  plot.title = name + " of " + std::to_string(series.values.size()) + " prints";
  plot.x.label = "print";
  plot.y.label = name;
  plot::Series seen{name, {}, series.values, plot::paint::blue, plot::SeriesStyle::points};
  for (std::size_t i = 0; i < series.values.size(); ++i) {
    const auto at = static_cast<double>(i + 1);
    seen.x.push_back(at);
    plot.series.push_back({i == 0 ? "expanded uncertainty" : "",
                           {at, at},
                           {series.values[i] - series.uncertainties[i], series.values[i] + series.uncertainties[i]},
                           plot::paint::grey,
                           plot::SeriesStyle::line});
  }
  plot.series.push_back(seen);
  plot::save(path, plot::draw(plot));
}

}  // namespace

void trend(const TrendOptions& options) {
  const AllSeries all = read_series(options.runs);
  const auto chosen = all.find(options.figure);
  if (!options.plot.empty() && chosen == all.end()) {
    std::vector<std::string> names;
    for (const auto& [name, series] : all) names.push_back(name);
    throw Error{Fault::usage,
                "--figure: '" + options.figure + "' is not in all reports; there are " + join(names, ", ")};
  }
  std::puts("figure,mean,spread,drift,drift_p,last,uncertainty");
  Json figures = Json::object();
  for (const auto& [name, series] : all) {
    const metrology::Trend found = metrology::trend_of(series.values, series.uncertainties);
    figures[name] = metrology::to_json(found);
    std::puts((name + "," + format_number(found.mean, 5) + "," + format_number(found.spread, 3) + "," +
               format_number(found.drift, 3) + "," + format_number(found.p, 3) + "," + format_number(found.last, 5) +
               "," + format_number(found.uncertainty, 3))
                  .c_str());
  }
  if (!options.plot.empty()) draw(options.plot, chosen->first, chosen->second);
  io::write_report(options.report, "vam-sdf-trend", {{"prints", options.runs.size()}, {"figures", figures}});
}

}  // namespace vam::sdf_tool
