// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/inspection.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "plot/curves.hpp"
#include "plot/page.hpp"
#include "vam-report/page_parts.hpp"

namespace vam::report_tool {

namespace {

std::string verdict_of(const Json& report) {
  const Json& require = report.at("require");
  const auto conditions = require.at("conditions").get<std::string>();
  if (conditions.empty()) return "";
  std::vector<std::string> unmet = require.at("unmet");
  const std::string words =
      unmet.empty() ? "The print conforms: " + conditions : "The print does not conform: " + join(unmet, "; ");
  const std::string band = require.at("guard_band").get<bool>() ? ", with the uncertainties as a guard band." : ".";
  return verdict(unmet.empty(), words + band);
}

// Numbers that have an uncertainty, as "print_to_design.rms_mm"; what differs from 0 by rounding is 0.
void add_rows(std::string& rows, const std::string& prefix, const Json& figures, const Json& uncertainty) {
  constexpr double least = 1e-9;
  const auto number = [](double value, int digits) {
    return format_number(std::abs(value) < least ? 0 : value, digits);
  };
  for (const auto& [key, value] : uncertainty.items()) {
    if (!figures.contains(key)) continue;
    if (value.is_object()) {
      add_rows(rows, prefix + key + ".", figures.at(key), value);
    } else if (value.is_number() && figures.at(key).is_number()) {
      const auto is = figures.at(key).get<double>();
      rows += "<tr><th>" + page_text(prefix + key) + "</th><td>" + number(is, 4) + "</td><td>&#177; " +
              number(value.get<double>(), 2) + "</td></tr>\n";
    }
  }
}

DimensionErrors errors_of(const Json& budget) {
  return {budget.at("surface_mm"),
          std::hypot(budget.at("isovalue_mm").get<double>(), budget.at("resolution_mm").get<double>()),
          budget.at("scale_percent").get<double>() / 100};
}

InspectionViews views_of(const Json& report, const std::string& name) {
  InspectionViews views;
  views.verdict = verdict_of(report);
  std::string rows;
  Json rest = report.at("expanded_uncertainty");
  rest.erase("design_to_print");  // in the whole report
  if (rest.contains("regions")) {
    add_rows(rows, "", report.at("regions"), rest.at("regions"));
    rest.erase("regions");
  }
  add_rows(rows, "", report, rest);
  const std::string source = report.at("uncertainty_budget").at("source");
  views.figures =
      "<h2>Inspection (" + page_text(name) +
      ")</h2>\n<div class=\"wrapped\"><table><tr><th>figure</th><th>value</th><th>expanded uncertainty, k = "
      "2</th></tr>\n" +
      rows + "</table></div>\n<p>The surface's uncertainty is that of the " + page_text(source) +
      "; vam-sdf(1) states what is contained.</p>\n";
  const plot::Histogram histogram{report.at("histogram").at("edges_mm"), report.at("histogram").at("area_percent")};
  if (histogram.edges.size() != histogram.percent.size() + 1 || histogram.percent.empty()) {
    throw Error{Fault::data, name + ": its histogram is damaged"};
  }
  views.limit_mm = histogram.edges.back();
  views.errors = errors_of(report.at("uncertainty_budget"));
  const double rms_mm = report.at("print_to_design").at("rms_mm");
  views.histogram = plot::page_figure(
      "Deviation by area", plot::page_plot(plot::deviation_histogram(histogram, rms_mm), "histogram of the deviation"),
      "The last bin holds all beyond it: " + format_number(histogram.percent.back(), 2) + " % of the area above " +
          format_number(histogram.edges[histogram.percent.size() - 1], 3) + " mm; the first one " +
          format_number(histogram.percent.front(), 2) + " % below " + format_number(histogram.edges[1], 3) + " mm.");
  return views;
}

}  // namespace

double DimensionErrors::expanded_mm(double size_mm) const {
  constexpr double coverage = 2;
  constexpr double beyond = 2.5;  // evenly between none and so much
  const double ends_mm = 2 * beyond * surface_mm / std::sqrt(3.0);
  return coverage * std::hypot(ends_mm, 2 * common_mm, scale * size_mm);
}

std::optional<InspectionViews> inspection_views(const std::vector<std::string>& reports) {
  for (const std::string& path : reports) {
    const Json report = parse_distinct(io::read_all(path), path);
    if (!is_of(report, "vam-sdf")) continue;
    (void)io::require_seal(report, path);
    try {
      return views_of(report, file_name(path));
    } catch (const Json::exception&) {
      throw Error{Fault::data, path + ": is not a whole report of vam-sdf"};
    }
  }
  return std::nullopt;
}

}  // namespace vam::report_tool
