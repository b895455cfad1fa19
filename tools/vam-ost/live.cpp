// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <filesystem>
#include <map>
#include <span>
#include <utility>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "device/os/event_log.hpp"
#include "io/image/view_source.hpp"
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

// When its views were taken, for whoever compares volumes over time.
std::map<std::string, std::string> facts_of(const metrology::SlidingTurn& turn, double time_s) {
  return {{"vam:turns", format_number(turn.turns(), 6)},
          {"vam:time_s", format_number(time_s, 12)},
          {"vam:turn_s", format_number(turn.turn_s(), 6)}};
}

std::vector<model::Condition> conditions_of(const Options& options) {
  if (options.until.empty()) return {};
  return model::parse_conditions(options.until, metrology::cured_names(), {"missing", "overcure"});
}

// Everything that a finished turn leaves behind; true when the print is done.
class Turns {
 public:
  Turns(Session& session, Print& print, const Options& options)
      : session_(session), print_(print), options_(options), conditions_(conditions_of(options)), log_(options.log) {
    if (options.output != "-") std::filesystem::create_directories(options.output);
  }

  bool finish(model::Volume& volume, std::span<const metrology::CameraView> views, Json line,
              const Session::Origin& origin) {
    hand_over(volume, views, origin);
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

  // Whoever watches the folder for a volume finds its uncertainty there.
  void hand_over(const model::Volume& volume, std::span<const metrology::CameraView> views,
                 const Session::Origin& origin) {
    char number[16];
    std::snprintf(number, sizeof number, "-%04d.vdb", index_++);
    if (options_.output == "-") return;
    const std::filesystem::path folder(options_.output);
    if (options_.uncertainties) {
      session_.write(session_.uncertainty(views), (folder / ("uncertainty" + std::string(number))).string(), origin);
    }
    session_.write(volume, (folder / ("scatter" + std::string(number))).string(), origin);
  }

  void say(const Json& line) { log_.line(line); }
  [[nodiscard]] int count() const { return index_; }

 private:
  Session& session_;
  Print& print_;
  const Options& options_;
  std::vector<model::Condition> conditions_;
  device::EventLog log_;
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
    const metrology::Exposure exposure = metrology::exposure_of(frame.image);
    if (!exposure.problem().empty()) {  // a print continues without a frame or two
      ++left_out;
      continue;
    }
    const bool due = turn.push(session.take(frame, exposure));
    if (!due) continue;
    Json line{{"turns", turn.turns()}, {"time_s", frame.time_s}, {"frames_left_out", left_out}};
    const std::vector<metrology::CameraView> views = turn.views();
    auto [volume, reason] = session.attempt(views, pixel_mm);
    if (!volume) {  // nothing has gelled yet, or frames are missing: the next turn may be better
      if (turns.count() > 0) warn("no volume after " + format_number(turn.turns(), 3) + " turns: " + reason);
      problem = reason;
      line["waiting"] = reason;
      turns.say(line);
      continue;
    }
    line["frames_waiting"] = frames.waiting();
    if (turns.finish(*volume, views, std::move(line), {history, facts_of(turn, frame.time_s)})) return;
  }
  if (turns.count() == 0) {
    throw Error{Fault::data,
                options.views + ": no volume, " + format_number(turn.turns(), 3) + " turns were recorded" +
                    (left_out > 0 ? " and " + std::to_string(left_out) + " dark or saturated frames skipped" : "") +
                    (problem.empty() ? "; a full turn with a visible print is needed" : "; last: " + problem)};
  }
}

}  // namespace vam::ost_tool
