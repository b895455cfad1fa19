// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-calibrate/bench.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/status_line.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/stream.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

namespace fs = std::filesystem;
using device::Command, device::Child, device::Manner;

constexpr const char* light_name = "vam-project";

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words words_of(const cli::PrinterOptions& printer) {
  Words words;
  if (!printer.file.empty()) words = {"--printer", printer.file};
  for (const std::string& setting : printer.sets) words = words + Words{"--set", setting};
  return words;
}

std::string folder_of(const AllOptions& options, const std::string& scratch) {
  if (options.keep.empty()) return scratch;
  std::error_code problem;
  fs::create_directories(options.keep, problem);
  if (!fs::is_directory(options.keep, problem))
    throw Error{Fault::no_output, options.keep + ": cannot create the folder"};
  return options.keep;
}

}  // namespace

Bench::Bench(const AllOptions& given) : options(given), work_(folder_of(given, scratch_.path())), log_(given.log) {
  records_ = io::load_printer(options.printer.file, options.printer.sets, io::Records::ignore).calibration;
  Words sets = options.printer.sets;  // old records must not stop the making of new ones
  sets.emplace_back("calibration.folder=");
  settings_ = words_of({options.printer.file, sets});
  printer = io::load_printer(options.printer.file, sets);
  io::write_text(file("printer.toml"), io::printer_toml(io::frozen(printer)));
  io::write_text(file("flips"), "");
  flips_.emplace(file("flips"));
}

void Bench::identify() {
  Json devices;
  devices["camera"] = ask("vam-capture");
  devices["stage"] = ask("vam-stage");
  most_deg_s_ = number_at(devices["stage"], "max_speed_deg_s");
  run({"plan", projector({"grey", "--plan"})});
  io::write_text(file("devices.json"), devices.dump() + "\n");
  correct_lag();
}

Json Bench::ask(const std::string& tool) {
  const std::string answer = scratch_.path() + "/answer";
  run({tool, Words{tool, "identify"} + settings_, {{STDOUT_FILENO, answer, O_WRONLY | O_CREAT | O_TRUNC}}});
  return parse_json(device::text_of(answer));
}

void Bench::begin(const std::string& scan, const std::string& place) {
  scan_ = scan;
  place_ = place;
  begun_ = std::chrono::steady_clock::now();
}

void Bench::note(const std::string& event, Json facts) {
  Json whole = Json::object();
  if (!scan_.empty()) whole["scan"] = scan_;
  whole.update(facts);
  log_(event, whole);
}

void Bench::start(const Command& command) {
  talk_.forget(command.name);
  tools_.emplace_back(command, talk_.path(command.name), Manner{.with_parent = true});
}

void Bench::run(const Command& command) {
  start(command);
  wait_for_tools();
  if (statuses_.at(command.name) != 0) fail(command.name);
}

void Bench::fail(const std::string& tool) const { throw Failed{statuses_.at(tool), talk_.text(tool)}; }

// Of a tool that was killed its guardian may have been, too.
void Bench::record(Child& tool, int status) {
  constexpr int signalled = 128;
  constexpr std::array ordered{SIGHUP, SIGINT, SIGPIPE, SIGTERM};
  statuses_[tool.name()] = status;
  if (status <= signalled || std::count(ordered.begin(), ordered.end(), status - signalled) > 0) return;
  status_line::hide();
  say("a tool was killed; vam-devices off: " + device::switch_off(talk_, file("printer.toml"), options.light));
}

// What lights must not end before.
void Bench::wait(int tick_ms, const std::function<bool()>& done) {
  while (!done()) {
    device::wait_for_an_end(tools_, tick_ms);
    const auto taken = std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - begun_);
    if (status_line::possible() && !place_.empty())
      status_line::show(program_name() + ": " + scan_ + ", " + place_ + ", " + std::to_string(taken.count()) + " s");
    std::erase_if(tools_, [this](Child& tool) {
      if (!tool.ends_within(0)) return false;
      record(tool, tool.status());
      return true;
    });
    if (statuses_.contains(light_name)) fail(light_name);
  }
}

void Bench::wait_for_tools() {
  constexpr int tick_ms = 1000;
  wait(tick_ms, [this] {
    return std::all_of(tools_.begin(), tools_.end(), [](const Child& tool) { return tool.name() == light_name; });
  });
}

Words Bench::projector(const Words& words) const {
  Words whole = Words{light_name, "--pattern"} + words + Words{"-o", options.display};
  if (!options.light.empty()) whole = whole + Words{"--light", options.light};
  return whole + settings_;
}

// A frame with light is in the log, behind what was read of it.
bool Bench::is_lit_anew() {
  for (Json line; flips_->next(line);) {
    if (number_at(line, "frame", -1) >= 0) return true;
  }
  return false;
}

void Bench::light(const Words& pattern) {
  constexpr int tick_ms = 20;
  constexpr std::chrono::seconds limit{20};
  while (is_lit_anew()) continue;  // those of the scan before
  start({light_name, projector(pattern + Words{"--repeat"}) + Words{"--log", file("flips"), "--die-with-parent"}});
  const auto until = std::chrono::steady_clock::now() + limit;
  wait(tick_ms, [&] {
    if (is_lit_anew()) return true;
    if (std::chrono::steady_clock::now() < until) return false;
    throw Failed{static_cast<int>(Fault::busy),
                 program_name() + ": " + options.display + ": no frame shown within 20 s\n"};
  });
}

void Bench::end() {
  status_line::hide();
  device::end_all(tools_, [this](Child& tool, int status) { record(tool, status); });
  statuses_.clear();
}

void Bench::move(int angle_deg) {
  Words words = Words{"vam-stage", "move"} + settings_;
  if (options.home) words.emplace_back("--home");
  run({"vam-stage", words + Words{"--angle", std::to_string(angle_deg * printer.stage.direction), "--speed",
                                  format_number(brisk_deg_s(), 4), "--die-with-parent"}});
}

Command Bench::camera(const std::string& name, Words words) const {
  words = Words{"vam-capture"} + settings_ + Words{"--set", "camera.exposure_us=" + format_number(exposure_us, 9)} +
          words + Words{"-o", file(name + ".exr")};
  fs::remove_all(file(name + ".exr"));
  return {"vam-capture", words};
}

void Bench::capture(const std::string& name, const Words& words) { run(camera(name, words)); }

void Bench::turn(const std::string& name, int turns, const Words& stage, const Words& words) {
  const std::string angles = scratch_.path() + "/angles";
  const std::string kept = scratch_.path() + "/kept";
  for (const std::string& pipe : {angles, kept}) {
    unlink(pipe.c_str());
    if (mkfifo(pipe.c_str(), 0600) != 0) throw Error{Fault::no_output, pipe + ": cannot be made"};
  }
  Words spin = Words{"vam-stage", "spin"} + settings_ + Words{"--turns", std::to_string(turns), "--run-up", "0.1"};
  if (options.home) spin.emplace_back("--home");
  start({"vam-stage", spin + stage + Words{"--die-with-parent"}, {{STDOUT_FILENO, angles, O_WRONLY}}});
  start({"tee",
         {"tee", "-a", file("angles.jsonl")},
         {{STDIN_FILENO, angles, O_RDONLY}, {STDOUT_FILENO, kept, O_WRONLY}}});
  Command seen = camera(name, Words{"--follow", "-"} + words);
  seen.files = {{STDIN_FILENO, kept, O_RDONLY}};
  start(seen);
  wait_for_tools();
  const bool is_seen = statuses_.at("vam-capture") == 0;
  const int stage_status = statuses_.at("vam-stage");
  if (stage_status != 0 && stage_status != 128 + SIGPIPE && !is_seen) fail("vam-stage");
  if (statuses_.at("tee") == 1) {  // as it says that it could not write
    throw Failed{static_cast<int>(Fault::io),
                 program_name() + ": " + file("angles.jsonl") + ": cannot be written; free space on the disk\n"};
  }
  if (!is_seen) fail("vam-capture");
}

void Bench::measure(const Words& words) {
  run({"vam-calibrate", Words{"vam-calibrate", scan_} + words_of(options.printer) +
                            Words{"--set", "camera.exposure_us=" + format_number(exposure_us, 9), frames(), "--devices",
                                  file("devices.json")} +
                            words});
}

void Bench::correct_lag() {
  if (const auto record = usable_record(records_, "lag")) {
    settings_ = settings_ + Words{"--set", "camera.lag_ms=" + format_number(record->value("camera_lag"), 17)};
  }
}

double Bench::brisk_deg_s() const {
  const double print = printer.stage.speed_deg_s;
  constexpr double brisk = 60;
  return std::max(print, std::min(brisk, most_deg_s_ > 0 ? most_deg_s_ : print));
}

}  // namespace vam::calibrate_tool
