// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-print/drive.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "device/os/clock.hpp"
#include "device/os/process.hpp"
#include "vam-print/commands.hpp"

namespace vam::print_tool {

namespace {

constexpr int tick_ms = 100;
constexpr int judged = static_cast<int>(Fault::judged);

bool is_of_views(const std::string& name) { return name == "capture" || name == "ost"; }

// It ends with this process also before it can say so itself.
bool ends_with_parent(const Command& command) {
  return std::find(command.words.begin(), command.words.end(), "--die-with-parent") != command.words.end();
}

bool is_order(int status) { return status == 128 + SIGHUP || status == 128 + SIGINT || status == 128 + SIGTERM; }

}  // namespace

void Drive::start() {
  std::ofstream(run_.file("angles.jsonl")) << std::flush;
  for (const Command& command : tools_of(run_))
    tools_.emplace_back(command, run_.talk.path(command.name),
                        Manner{.with_parent = ends_with_parent(command), .shared = run_.lock});
  life_.reach(State::homed);
  run_.note("started");
  const bool terminal = isatty(STDERR_FILENO) == 1;
  if (terminal || run_.options.page) {
    watcher_.emplace(print_tool::watch(run_), "/dev/null", Manner{.nice = true, .on_terminal = terminal});
  }
  if (run_.options.correct) {
    Command renewal = renew(run_);
    renewal.words.insert(renewal.words.end(), {"--die-with", std::to_string(getpid())});
    renewal_.emplace(renewal, run_.talk.path("renew"), Manner{.nice = true});
  }
  steward_.emplace(run_, tools_);
  std::vector<std::string> logs;
  for (const char* log : {"flips", "angles", "stage", "capture", "ost", "renewed"})
    logs.push_back(run_.file(std::string(log) + ".jsonl"));
  keeper_.emplace(logs, [this](const Json& stated) {
    run_.note("sealed", {{"logs", stated}});
    run_.keep_events();
  });
  // A busy machine must not hold up the order to end.
  device::hurry(device::Urgency::driver);
}

// Which state the logs show.
void Drive::look() {
  run_.look();
  if (life_.state() == State::homed) {
    std::ifstream angles(run_.file("angles.jsonl"));
    if (angles.peek() != std::ifstream::traits_type::eof()) life_.reach(State::turning);
  }
  if (life_.state() == State::turning && run_.is_lit()) life_.reach(State::lit);
}

int Drive::watch() {
  while (!tools_.empty()) {
    const bool ticks = life_.state() < State::lit || life_.state() == State::held;
    device::wait_for_an_end(tools_, ticks ? tick_ms : -1);
    look();
    if (life_.state() == State::held) require_planned_end();
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      if (!tools_[i].ends_within(0)) continue;
      Child tool = std::move(tools_[i]);
      tools_.erase(tools_.begin() + static_cast<std::ptrdiff_t>(i));
      if (const auto status = take_end(std::move(tool))) return *status;
      break;
    }
  }
  life_.reach(State::still);
  return complete();
}

// A status where the print is over by it.
std::optional<int> Drive::take_end(Child tool) {
  const int status = tool.status();
  const std::string name = tool.name();
  const bool fails = status != 0 && loss_of(name) == Loss::fails;
  const bool alone = name == "ost" && others_run();  // nobody reads from it: it is its own cause
  if (fails) order_end();                            // before anything that takes time
  record(tool, status);
  run_.note("ended", {{"tool", name}, {"status", run_.statuses[name]}});
  const bool lost_reader = name == "capture" && status == 128 + SIGPIPE;  // vam-ost has ended, and is not seen yet
  if ((name == "ost" || lost_reader) && has_stop()) {
    run_.outcome = "stopped by vam-ost";
    return 0;
  }
  if (fails) give_up(name, alone);
  if (status != 0) {
    if (is_of_views(name) && life_.state() == State::lit && !printed()) hold(name);
    return {};
  }
  if (name != "project") return {};
  life_.reach(State::dark);
  if (run_.open_loop_from) end_open_loop();
  if (!run_.is_corrected()) return {};
  run_.outcome = "complete, corrected";
  return 0;
}

// By the table; a print is corrected, or its views are like any other tool.
Loss Drive::loss_of(const std::string& name) const {
  const StateRule& rule = life_.rule();
  if (!run_.options.correct || !is_of_views(name)) return rule.tool_lost;
  const bool is_held = rule.views_lost == Loss::is_held;
  return is_held && !views_alone_failed() ? Loss::fails : rule.views_lost;
}

void Drive::record(Child& tool, int status) {
  const std::string& name = tool.name();
  constexpr int signalled = 128;
  run_.statuses[name] = name == "lines" && status == 1 ? static_cast<int>(Fault::io) : status;  // as tee has it
  if (name == "project") run_.dark_s = device::real_clock().now_s();
  if (status > signalled && is_left_on(run_, tool)) switch_off(run_, name + " was");
}

bool Drive::printed() const {
  const auto project = run_.statuses.find("project");
  return project != run_.statuses.end() && project->second == 0;
}

bool Drive::has_stop() const { return !text_of(run_.file("stop.json")).empty(); }

// Nothing else failed, which would have pulled them along.
bool Drive::views_alone_failed() const {
  return !has_stop() && std::all_of(tools_.begin(), tools_.end(),
                                    [](const Child& tool) { return is_of_views(tool.name()) || !tool.ends_within(0); });
}

bool Drive::others_run() const {
  return std::none_of(tools_.begin(), tools_.end(), [](const Child& tool) { return tool.ends_within(0); });
}

// What fails pulls others along, the stage's own error before all; 143 is our order.
void Drive::give_up(std::string name, bool alone) {
  constexpr std::chrono::milliseconds while_others_fail{200};
  if (!alone) {
    std::this_thread::sleep_for(while_others_fail);
    std::erase_if(tools_, [&](Child& tool) {
      if (is_stopped(tool, getpid())) end_stopped(run_, tool);  // the others had waited for it
      constexpr int soon_ms = 20;
      if (!tool.ends_within(soon_ms)) return false;
      record(tool, tool.status());
      return true;
    });
    for (const char* candidate : {"stage", "lines", "project", "capture", "ost"}) {
      if (run_.open_loop_from && is_of_views(candidate)) continue;  // whose failure did not end it
      const auto ended = run_.statuses.find(candidate);
      if (ended == run_.statuses.end() || ended->second == 0) continue;
      if (ended->second == 128 + SIGPIPE || ended->second == 128 + SIGTERM) continue;
      name = candidate;
      break;
    }
  }
  const int status = run_.statuses[name];
  if (is_order(status)) {  // that this process was told to ignore, or that only the tool was given
    say("aborted: " + name + " was ended by a signal");
    throw Ended{status};
  }
  run_.outcome = name + " failed";
  run_.fail(name, status);
}

// A print that is corrected goes on when its camera is lost, or vam-ost: as planned, or as it was corrected.
void Drive::hold(const std::string& name) {
  life_.reach(State::held);
  constexpr double digits = 100;
  run_.open_loop_from = std::round(run_.turns_shown() * digits) / digits;
  run_.planned_turns = std::ceil(run_.planned_turns);
  run_.note("open-loop", {{"tool", name}, {"turns", *run_.open_loop_from}});
  std::string how = "as it was corrected";
  if (!run_.is_corrected()) {
    const std::string planned = format_number(run_.planned_turns);
    how = run_.turns_shown() >= run_.planned_turns ? "and ends now: all " + planned + " planned turns are done"
                                                   : "as planned, to turn " + planned;
  }
  const std::string said = last_line(run_.talk.text(name));
  say("warning: " + (said.empty() ? name + " failed" : said) + "; the print goes on in open loop from turn " +
      fixed_number(*run_.open_loop_from, 2) + ", " + how);
}

// Or when there is new light, which says itself when it ends.
void Drive::require_planned_end() {
  if (!run_.is_corrected() && run_.turns_shown() >= run_.planned_turns) end_open_loop();
}

void Drive::end_open_loop() {
  run_.outcome = "complete, in open loop";
  end_all();
  say("the print ended in open loop: nothing was measured after turn " + fixed_number(*run_.open_loop_from, 2));
  throw Ended{judged};
}

void Drive::end_all() {
  order_end();
  device::end_all(tools_, [this](Child& tool, int status) { record(tool, status); });
  if (life_.state() != State::armed) life_.reach(State::still);
  steward_.reset();
  device::take_time();
  end_renewal();
}

// Dark, then still.
void Drive::order_end() {
  for (const char* name : {"project", "stage", "capture", "ost", "lines"}) {
    for (const Child& tool : tools_) {
      if (tool.name() == name) tool.order(SIGTERM);
    }
  }
  if (life_.state() != State::armed) life_.reach(State::dark);
}

void Drive::end_renewal() {
  if (!renewal_) return;
  constexpr int patience_ms = 60000;  // for a step of it that is under way
  renewal_->order(SIGTERM);
  const int status = renewal_->status(patience_ms);
  renewal_.reset();
  run_.look();
  if (status != 0 && status != 128 + SIGTERM) {
    return say("warning: vam-correct renew ended with status " + std::to_string(status) + ": " +
               last_line(run_.talk.text("renew")) + "; the print went on without new light");
  }
  if (run_.is_corrected() || run_.open_loop_from || !run_.is_lit()) return;
  say("warning: the print was not corrected: " + reason_as_before() + "; see " + run_.file("renewed.jsonl"));
}

// By what became of the last volume.
std::string Drive::reason_as_before() const {
  const Json last = parse_json(last_line(text_of(run_.file("renewed.jsonl"))));
  if (text_at(last, "event") == "renewed") return "the first new light was ready when the print ended";
  return text_at(last, "reason", "there was no volume of the resin");
}

// It ends by itself when it has read the end, which takes seconds on a busy machine.
void Drive::end_watching() {
  constexpr int patience_ms = 10000;
  if (watcher_) (void)watcher_->status(patience_ms);
  watcher_.reset();
}

// Every tool has ended by itself.
int Drive::complete() {
  for (const char* name : {"stage", "lines", "capture", "ost"}) {
    const auto ended = run_.statuses.find(name);
    if (ended == run_.statuses.end() || ended->second == 0) continue;
    run_.outcome = std::string(name) + " failed after the print";
    run_.fail(name, ended->second);
  }
  if (run_.options.until.empty()) {
    run_.outcome = "done";
    return 0;
  }
  run_.outcome = "complete, --until not met";
  const Json figures = parse_json(last_line(text_of(run_.file("ost.jsonl"))));
  std::vector<std::string> last;
  for (const char* key : {"turns", "missing_percent", "overcure_percent", "iou"}) {
    if (figures.is_object() && figures.contains(key))
      last.push_back(std::string(key) + " " + format_number(number_at(figures, key), 4));
  }
  say("--until '" + run_.options.until + "' was not met in " + std::to_string(run_.turns) +
      " turns; last figures: " + (last.empty() ? "none, no print was visible" : join(last, ", ")));
  return judged;
}

}  // namespace vam::print_tool
