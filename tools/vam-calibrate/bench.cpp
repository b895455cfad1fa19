// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-calibrate/bench.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <utility>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/status_line.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "device/os/clock.hpp"
#include "device/os/interrupt.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/stream.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

namespace fs = std::filesystem;
using device::Command, device::Child, device::Manner;

constexpr int killed = 128 + SIGKILL;
constexpr int to_end = O_WRONLY | O_CREAT | O_APPEND;

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

// A log of flips has a frame with light behind that byte.
bool has_frame(const std::string& flips, std::uintmax_t behind) {
  std::ifstream log(flips, std::ios::binary);
  log.seekg(static_cast<std::streamoff>(behind));
  constexpr std::string_view key = "\"frame\":";
  for (std::string line; std::getline(log, line);) {
    const std::size_t at = line.find(key);
    if (at != std::string::npos && std::isdigit(static_cast<unsigned char>(line[at + key.size()])) != 0) return true;
  }
  return false;
}

}  // namespace

Bench::Bench(const AllOptions& given)
    : options(given), work_(folder_of(given, scratch_.path())), flips_(file("flips")), log_(given.log) {
  records_ = io::load_printer(options.printer.file, options.printer.sets, io::Records::ignore).calibration;
  Words sets = options.printer.sets;  // old records must not stop the making of new ones
  sets.emplace_back("calibration.folder=");
  settings_ = words_of({options.printer.file, sets});
  printer = io::load_printer(options.printer.file, sets);
  io::write_text(file("printer.toml"), io::printer_toml(io::frozen(printer)));
  fs::remove(flips_);
  std::ofstream(flips_).close();
}

void Bench::identify() {
  Json devices;
  devices["camera"] = ask("vam-capture");
  devices["stage"] = ask("vam-stage");
  most_deg_s_ = number_at(devices["stage"], "max_speed_deg_s");
  Words plan{"vam-project", "--pattern", "grey", "--plan", "-o", options.display};
  if (!options.light.empty()) plan = plan + Words{"--light", options.light};
  run({"vam-project", plan + settings_});
  io::write_text(file("devices.json"), devices.dump() + "\n");
  correct_lag();
}

// One that is late is asked again.
Json Bench::ask(const std::string& tool) {
  constexpr double pause_s = 2;
  const std::string answer = scratch_.path() + "/answer";
  for (int tries = 1;; ++tries) {
    try {
      run({tool, Words{tool, "identify"} + settings_, {{STDOUT_FILENO, answer, O_WRONLY | O_CREAT | O_TRUNC}}});
      return parse_json(device::text_of(answer));
    } catch (const Failed& failed) {
      if (failed.status != static_cast<int>(Fault::busy) || tries > 2) throw;
    }
    device::real_clock().sleep_until(device::real_clock().now_s() + pause_s);
  }
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
  wait();
  if (const int status = statuses_.at(command.name); status != 0) fail(command.name, status);
}

void Bench::fail(const std::string& tool, int status) const { throw Failed{status, talk_.text(tool)}; }

// Of a tool that was killed its guardian may have been, too.
int Bench::took(const std::string& tool, int status) {
  constexpr int signalled = 128;
  const bool ordered = status == signalled + SIGHUP || status == signalled + SIGINT || status == signalled + SIGPIPE ||
                       status == signalled + SIGTERM;
  statuses_[tool] = status;
  if (status > signalled && !ordered) {
    status_line::hide();
    say("a tool was killed; vam-devices off: " + device::switch_off(talk_, file("printer.toml"), options.light));
  }
  return status;
}

// Until all have ended; what lights must not end before.
void Bench::wait() {
  constexpr int tick_ms = 1000;
  while (!tools_.empty()) {
    std::vector<pollfd> events{{device::interrupt_fd(), POLLIN, 0}};
    for (const auto* children : {&tools_, &projector_}) {
      for (const Child& child : *children) events.push_back({child.handle(), POLLIN, 0});
    }
    poll(events.data(), events.size(), tick_ms);
    device::check_interrupted();
    const auto taken = std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - begun_);
    if (status_line::possible() && !place_.empty()) {
      status_line::show(program_name() + ": " + scan_ + ", " + place_ + ", " + std::to_string(taken.count()) + " s");
    }
    std::erase_if(tools_, [this](Child& tool) {
      if (!tool.ends_within(0)) return false;
      took(tool.name(), tool.status());
      return true;
    });
    if (projector_.empty() || !projector_.front().ends_within(0)) continue;
    const int status = took("vam-project", projector_.front().status());
    projector_.clear();
    fail("vam-project", status);
  }
}

void Bench::light(const Words& pattern) {
  constexpr int tries = 1000;
  constexpr int tick_ms = 20;
  const std::uintmax_t before = fs::file_size(flips_);
  Words words = Words{"vam-project", "--pattern"} + pattern + Words{"--repeat", "-o", options.display};
  if (!options.light.empty()) words = words + Words{"--light", options.light};
  words = words + settings_ + Words{"--log", flips_, "--die-with-parent"};
  talk_.forget("vam-project");
  projector_.emplace_back(Command{"vam-project", words}, talk_.path("vam-project"), Manner{.with_parent = true});
  for (int i = 0; !has_frame(flips_, before); ++i) {
    device::check_interrupted();
    if (i == tries) {
      throw Failed{static_cast<int>(Fault::busy),
                   program_name() + ": " + options.display + ": no frame shown within 20 s\n"};
    }
    if (!projector_.front().ends_within(tick_ms)) continue;
    const int status = took("vam-project", projector_.front().status());
    projector_.clear();
    fail("vam-project", status);
  }
}

void Bench::dark() {
  device::end_all(projector_, [this](Child& tool, int status) { took(tool.name(), status); });
}

void Bench::end() {
  status_line::hide();
  for (const auto* children : {&projector_, &tools_}) {
    for (const Child& child : *children) child.order(SIGTERM);
  }
  dark();
  device::end_all(tools_, [this](Child& tool, int status) { took(tool.name(), status); });
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
  wait();
  const int camera_status = statuses_.at("vam-capture");
  const int stage_status = statuses_.at("vam-stage");
  if (stage_status != 0 && stage_status != 128 + SIGPIPE && camera_status != 0) fail("vam-stage", stage_status);
  if (statuses_.at("tee") == 1) {  // as it says that it could not write
    throw Failed{static_cast<int>(Fault::io),
                 program_name() + ": " + file("angles.jsonl") + ": cannot be written; free space on the disk\n"};
  }
  if (camera_status != 0) fail("vam-capture", camera_status);
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
