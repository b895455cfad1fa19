#include <cstdio>
#include <filesystem>

#include "base/error.hpp"
#include "io/event_log.hpp"
#include "io/stream.hpp"
#include "metrology/sliding_turn.hpp"
#include "model/conditions.hpp"
#include "vam-ost/session.hpp"

namespace vam::ost_tool {

namespace {

void write_page(const Options& options) {
  if (options.page.empty()) return;
  io::OutputFile page(options.page, io::Content::text);
  const std::string picture = std::filesystem::path(options.projections).filename().string();
  page.write(
      "<!doctype html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"2\"><title>vam-ost</title>"
      "<body style=\"margin:0;background:#fff\"><img src=\"" +
      picture + "\" style=\"max-width:100%\">\n");
  page.commit();
}

}  // namespace

void live(const cli::App& app, const Options& options) {
  std::vector<model::Condition> conditions;
  if (!options.until.empty()) conditions = model::parse_conditions(options.until, metrology::cured_names());
  if (!options.page.empty() && options.projections.empty())
    throw Error{Fault::usage, "--page: needs --projections, the picture that it shows"};
  Session session(app, options);
  const bool keep = options.output != "-";
  if (keep) std::filesystem::create_directories(options.output);
  const auto log = io::open_log(options.log);
  io::ViewSource source(options.views, options.step_deg);
  metrology::SlidingTurn turn(options.every_deg);
  io::CameraFrame frame;
  for (int index = 0; source.next(frame);) {
    if (!turn.push(session.take(frame))) continue;
    const model::Volume volume = session.reconstruct(turn.views(), source.pixel_mm());
    char name[32];
    std::snprintf(name, sizeof name, "scatter-%04d.vdb", index++);
    if (keep) session.write(volume, (std::filesystem::path(options.output) / name).string(), source.history());
    session.write_print(volume);
    write_page(options);
    Json line{{"turns", turn.turns()}, {"time_s", frame.time_s}};
    const auto state = session.state(volume);
    if (state) line.update(metrology::to_json(*state));
    if (log) io::log_line(*log, line.dump());
    if (conditions.empty() || !state) continue;
    if (!model::unmet(conditions, [&](const std::string& wanted) { return metrology::figure(*state, wanted); }).empty())
      continue;
    line["event"] = "stop";
    line["condition"] = options.until;
    std::puts(line.dump().c_str());
    break;
  }
}

}  // namespace vam::ost_tool
