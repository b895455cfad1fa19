// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-report/content.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "base/log/progress.hpp"
#include "base/text/base64.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/json_fwd.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/inspect/provenance.hpp"
#include "io/settings/csv_table.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/stream.hpp"
#include "plot/curves.hpp"
#include "plot/page.hpp"
#include "session/dose_score.hpp"
#include "session/printer.hpp"
#include "vam-report/body.hpp"
#include "vam-report/inspection.hpp"
#include "vam-report/light.hpp"
#include "vam-report/meshes.hpp"
#include "vam-report/page_parts.hpp"
#include "vam-report/volumes.hpp"

namespace vam::report_tool {

namespace {

// Figures, iterations and provenance as tables and curves.

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

/// HTML: one row a figure, those of objects within as "with_surface.ver".
std::string figures_table(const Json& figures) {
  std::string rows;
  add_rows(rows, "", figures);
  return "<div class=\"wrapped\"><table>" + rows + "</table></div>\n";
}

/// HTML of a report in JSON, folded. Throws Fault::data for a seal that is not its own, and what reading throws.
std::string report_table(const std::string& path) {
  const Json report = parse_distinct(io::read_all(path), path);
  if (!report.is_object()) throw Error{Fault::data, path + ": is not a JSON object"};
  (void)io::require_seal(report, path);
  const std::string schema = report.contains("schema") ? ", " + text_of(report["schema"]) : "";
  return "<details><summary>" + page_text(file_name(path) + schema) + "</summary>" + figures_table(report) +
         "</details>\n";
}

/// HTML: the verdict that one of the reports states, or how the page would have one. Throws as report_table().
std::string stated_verdict(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    const Json report = parse_distinct(io::read_all(path), path);
    if (!report.is_object() || !report.contains("verdict") || !report["verdict"].is_string()) continue;
    const std::string words = text_of(report["verdict"]);
    const bool good = words.starts_with("will print:") || words.starts_with("met:") || words == "go";
    return verdict(good, file_name(path) + ": " + words);
  }
  return "<p class=\"verdict\">Not judged: that takes a dose and its target, or a report that states a verdict.</p>\n";
}

/// HTML: VER and process window over the iterations. Throws what read_csv throws.
std::string convergence(const std::string& path) {
  const io::CsvTable table = io::read_csv(path, {"iteration", "ver", "pw"});
  const plot::Trace trace{"", table.column(0), table.column(1), table.column(2)};
  return plot::page_figure("Convergence", plot::page_plot(plot::convergence({trace}), "figures over the iterations"),
                           file_name(path) + ": the part prints if the process window is positive.");
}

/// HTML: the commands that each file was made by, with the seals of what they wrote.
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

/// Of a grey target.
std::optional<score::GreyScore> judge_grey(const Volumes& volumes, const cli::PrinterOptions& printer,
                                           const session::GreyChoice& grey) {
  const io::SparseVolume* dose = volumes.find("dose");
  const io::SparseVolume* target = volumes.find("target");
  if (dose == nullptr || target == nullptr) return std::nullopt;
  const model::Printer own = session::printer_of(printer, dose->metadata, "dose");
  return session::score_grey(*dose, *target, grey, volumes.find("tolerance"), own, "dose");
}

/// A dose with its target, and what it is worth.
struct Judged {
  score::ScoreOptions how;
  score::Score score;
};

std::optional<Judged> judge(const Volumes& volumes, const cli::PrinterOptions& printer) {
  const io::SparseVolume* dose = volumes.find("dose");
  const io::SparseVolume* target = volumes.find("target");
  if (dose == nullptr || target == nullptr) return std::nullopt;
  session::warn_of_grey(*target, target->name());
  score::ScoreOptions how;
  session::resolve_exposure(how, *dose, *target, session::printer_of(printer, dose->metadata, "dose"));
  return Judged{how, session::score_print(*dose, *target, how)};
}

std::string images(const std::vector<std::string>& paths) {
  std::string views;
  for (const std::string& path : paths) {
    const std::string png = base64(io::read_all(path, io::Content::binary));
    views += plot::page_figure(
        file_name(path), "<img src=\"data:image/png;base64," + png + "\" alt=\"" + page_text(file_name(path)) + "\">",
        "");
  }
  return views;
}

std::string views(const Sources& sources, const Volumes& volumes, const std::optional<Judged>& judged,
                  const std::optional<InspectionViews>& inspection, const Wanted& wanted) {
  std::string made = "<div class=\"images\">\n";
  constexpr int bodies_and_sections = 3;
  Progress progress("drawing", bodies_and_sections + std::ssize(sources.stacks) + std::ssize(sources.videos));
  if (const io::SparseVolume* target = volumes.find("target"); target != nullptr && !wanted.grey.is_target) {
    std::optional<PrintedDose> print;
    if (judged) print = {volumes.find("dose"), judged->score.print_threshold()};
    made += body_view(*target, print, volumes.find("insert"));
  }
  progress.tick();
  if (!sources.meshes.empty()) {
    const std::vector<ShownMesh> meshes = read_meshes(sources.meshes);
    made += meshes_view(meshes, inspection ? std::optional(inspection->limit_mm) : std::nullopt);
    const bool has_print = !meshes.empty() && !meshes.front().colours.empty();
    made += mesh_sections(meshes, inspection && has_print ? std::optional(inspection->errors) : std::nullopt);
  }
  progress.tick();
  if (inspection) made += inspection->histogram;
  made +=
      section_views(volumes, wanted.sections, !wanted.grey.is_target, judged ? judged->how.threshold : std::nullopt);
  if (judged) made += cure_views(volumes, judged->how, judged->score.print_threshold(), wanted.sections);
  progress.tick();
  const auto show = [&](const std::vector<std::string>& paths, io::FileType type) {
    for (const std::string& path : paths) {
      made += light_view(path, type, wanted.projections);
      progress.tick();
    }
  };
  show(sources.stacks, io::FileType::stack);
  show(sources.videos, io::FileType::video);
  if (judged) made += histogram(volumes, judged->how);
  for (const std::string& trace : sources.traces) made += convergence(trace);
  return made + images(sources.images) + "</div>\n";
}

}  // namespace

std::string content(const cli::App& app, const Sources& sources, const cli::PrinterOptions& printer,
                    const Wanted& wanted) {
  const bool is_grey = wanted.grey.is_target;
  if (sources.volumes.empty()) app.require_for(no_volume, wanted.title);
  if (sources.stacks.empty() && sources.videos.empty()) app.require_for(no_light, wanted.title);
  const Volumes volumes = read_volumes(sources.volumes, is_grey ? io::TargetKind::grey : io::TargetKind::coverage);
  if (volumes.find("target") == nullptr) app.require_for(no_target, wanted.title);
  if (volumes.find("dose") == nullptr) app.require_for(no_dose, wanted.title);
  const std::optional<Judged> judged = is_grey ? std::nullopt : judge(volumes, printer);
  const std::optional<score::GreyScore> grey = is_grey ? judge_grey(volumes, printer, wanted.grey) : std::nullopt;
  std::string made = "<h1>" + page_text(wanted.title) + "</h1>\n";
  if (judged) {
    const verdict::Verdict found = judged->score.verdict();
    made += report_tool::verdict(found.answer == verdict::Answer::yes, found.words);
  }
  if (grey) made += report_tool::verdict(grey->is_met(), grey->verdict());
  const std::optional<InspectionViews> inspection = inspection_views(sources.reports);
  if (inspection) made += inspection->verdict;
  if (!judged && !grey && (!inspection || inspection->verdict.empty())) made += stated_verdict(sources.reports);
  made += views(sources, volumes, judged, inspection, wanted);
  if (inspection) made += inspection->figures;
  if (judged || grey) {
    made += "<h2>Figures of merit</h2>\n" + figures_table(judged ? judged->score.figures() : grey->figures());
  }
  if (!sources.reports.empty()) made += "<h2>Reports</h2>\n";
  for (const std::string& report : sources.reports) made += report_table(report);
  std::vector<std::string> made_by = sources.volumes;
  made_by.insert(made_by.end(), sources.stacks.begin(), sources.stacks.end());
  if (!made_by.empty()) made += "<h2>Provenance</h2>\n" + provenance(made_by);
  return made + "<p class=\"none\">" + page_text(app.history()) + "</p>\n";
}

}  // namespace vam::report_tool
