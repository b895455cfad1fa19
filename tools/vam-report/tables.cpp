// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/tables.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/inspect/provenance.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "plot/curves.hpp"
#include "plot/page.hpp"
#include "vam-report/page_parts.hpp"

namespace vam::report_tool {

namespace {

constexpr std::size_t most_values = 24;  // of a list that is written out

std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return format_figure(value.get<double>(), 5);
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string list_of(const Json& values) {
  std::vector<std::string> parts;
  for (const Json& value : values) {
    if (parts.size() == most_values) {
      parts.push_back("... (" + std::to_string(values.size()) + " values)");
      break;
    }
    parts.push_back(text_of(value));
  }
  return join(parts, ", ");
}

void add_rows(std::string& rows, const std::string& prefix, const Json& object) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object()) {
      add_rows(rows, prefix + key + ".", value);
      continue;
    }
    if (key == "schema" || key == "seal") continue;
    rows += "<tr><th>" + page_text(prefix + key) + "</th><td>" +
            page_text(value.is_array() ? list_of(value) : text_of(value)) + "</td></tr>\n";
  }
}

}  // namespace

std::string figures_table(const Json& figures) {
  std::string rows;
  add_rows(rows, "", figures);
  return "<div class=\"wrapped\"><table>" + rows + "</table></div>\n";
}

std::string report_table(const std::string& path) {
  const Json report = parse_distinct(io::read_all(path), path);
  if (!report.is_object()) throw Error{Fault::data, path + ": is not a JSON object"};
  (void)io::require_seal(report, path);
  const std::string schema = report.contains("schema") ? ", " + text_of(report["schema"]) : "";
  return "<details><summary>" + page_text(file_name(path) + schema) + "</summary>" + figures_table(report) +
         "</details>\n";
}

std::string convergence(const std::string& path) {
  const io::CsvTable table = io::read_csv(path, {"iteration", "ver", "pw"});
  const plot::Trace trace{"", table.column(0), table.column(1), table.column(2)};
  return plot::page_figure("Convergence", plot::page_plot(plot::convergence({trace}), "figures over the iterations"),
                           file_name(path) + ": the part prints if the process window is positive.");
}

std::string provenance(const std::vector<std::string>& paths) {
  std::string made;
  for (const std::string& path : paths) {
    for (const io::ProvenanceEntry& finding : io::inspect(path, true)) {
      made += "<details><summary>" + page_text(file_name(path) + ": " + finding.what) + "</summary><table>";
      made += "<tr><th>command</th><th>seal of the file written</th></tr>\n";
      for (const auto& [command, seal] : io::chain_of(finding)) {
        made += "<tr><td><code>" + page_text(command) + "</code></td><td><code>" +
                page_text(seal.empty() ? "not sealed" : seal) + "</code></td></tr>\n";
      }
      made += "</table></details>\n";
    }
  }
  return made;
}

}  // namespace vam::report_tool
