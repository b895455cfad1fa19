// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/log.hpp"
#include "base/printable.hpp"
#include "base/text.hpp"
#include "io/image/view_queue.hpp"
#include "io/settings/json_log.hpp"
#include "io/stream/stream.hpp"
#include "metrology/ost/sliding_turn.hpp"
#include "model/conditions.hpp"
#include "vam-ost/print.hpp"
#include "vam-ost/session.hpp"

namespace vam::ost_tool {

namespace {

// The operator's page: the figures of the latest turn over the image, which the browser must not cache.
void write_page(const Options& options, int index, const Json& line) {
  if (options.page.empty()) return;
  std::string words = "turn " + format_number(line.at("turns").get<double>(), 4);
  for (const char* name : {"missing_percent", "overcure_percent", "iou"}) {
    if (line.contains(name)) words += ", " + std::string(name) + " " + format_number(line.at(name).get<double>(), 4);
  }
  const std::string image = std::filesystem::path(options.projections).filename().string();
  io::write_text(
      options.page,
      "<!doctype html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"2\"><title>vam-ost</title>"
      "<body style=\"margin:1em;background:#fff;font-family:sans-serif\"><p>" +
          words + "</p><img src=\"" + link_text(image) + "?" + std::to_string(index) +
          "\" style=\"max-width:100%\">\n");
}

std::vector<model::Condition> conditions_of(const Options& options) {
  if (options.until.empty()) return {};
  return model::parse_conditions(options.until, metrology::cured_names(), {"missing", "overcure"});
}

// Everything that a finished turn leaves behind; true when the print is done.
class Turns {
 public:
  Turns(Session& session, Print& print, const Options& options)
      : session_(session),
        print_(print),
        options_(options),
        conditions_(conditions_of(options)),
        log_(io::open_log(options.log)) {
    if (options.output != "-") std::filesystem::create_directories(options.output);
  }

  bool finish(model::Volume& volume, Json line, const std::vector<std::string>& history) {
    char name[32];
    std::snprintf(name, sizeof name, "scatter-%04d.vdb", index_++);
    if (options_.output != "-")
      session_.write(volume, (std::filesystem::path(options_.output) / name).string(), history);
    print_.keep(volume);
    print_.write(volume);
    const auto state = print_.state(volume);
    if (state) line.update(metrology::to_json(*state));
    line["dirt"] = session_.dirt();
    line["run_out"] = session_.run_out();
    if (const auto bodies = print_.bodies()) line["bodies"] = metrology::to_json(*bodies);
    write_page(options_, index_, line);
    say(line);
    if (conditions_.empty()) return false;
    const auto value = [&](const std::string& wanted) { return metrology::figure(*state, wanted); };
    if (!model::unmet(conditions_, value).empty()) return false;
    line["event"] = "stop";
    line["condition"] = options_.until;
    std::puts(line.dump().c_str());
    std::fflush(stdout);
    return true;
  }

  void say(const Json& line) {
    if (log_) io::log_line(*log_, line.dump());
  }
  [[nodiscard]] int count() const { return index_; }

 private:
  Session& session_;
  Print& print_;
  const Options& options_;
  std::vector<model::Condition> conditions_;
  io::JsonLog log_;
  int index_ = 0;
};

}  // namespace

void live(const cli::App& app, const Options& options) {
  Session session(app, options);
  Print print(app, options, session.printer().camera);
  Turns turns(session, print, options);
  io::ViewSource source(options.views, options.step_deg.value_or(0));
  const double pixel_mm = source.pixel_mm();
  const auto history = source.history();
  io::ViewQueue frames(source);  // from here on the source is its thread's
  metrology::SlidingTurn turn(options.every_deg);
  int left_out = 0;
  std::string problem;  // of the last turn without a volume
  io::CameraFrame frame;
  while (frames.next(frame)) {
    if (!metrology::exposure_problem(frame.image).empty()) {  // a print continues without a frame or two
      ++left_out;
      continue;
    }
    const bool due = turn.push(session.take(frame));
    if (!due) continue;
    Json line{{"turns", turn.turns()}, {"time_s", frame.time_s}, {"frames_left_out", left_out}};
    auto [volume, reason] = session.attempt(turn.views(), pixel_mm);
    if (!volume) {  // nothing has gelled yet, or frames are missing: the next turn may be better
      if (turns.count() > 0) warn("no volume after " + format_number(turn.turns(), 3) + " turns: " + reason);
      problem = reason;
      line["waiting"] = reason;
      turns.say(line);
      continue;
    }
    line["frames_waiting"] = frames.waiting();
    if (turns.finish(*volume, std::move(line), history)) return;
  }
  if (turns.count() == 0) {
    throw Error{Fault::data,
                options.views + ": no volume, " + format_number(turn.turns(), 3) + " turns were recorded" +
                    (left_out > 0 ? " and " + std::to_string(left_out) + " dark or saturated frames skipped" : "") +
                    (problem.empty() ? "; a full turn with a visible print is needed" : "; last: " + problem)};
  }
}

}  // namespace vam::ost_tool
