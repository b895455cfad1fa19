// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-print/arm.hpp"

#include <sys/stat.h>

#include <ctime>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "vam-print/commands.hpp"
#include "vam-print/resume.hpp"

namespace vam::print_tool {

namespace {

namespace fs = std::filesystem;

constexpr int data_status = static_cast<int>(Fault::data);
constexpr int usage_status = static_cast<int>(Fault::usage);

std::string stamp() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  return {text, std::strftime(text, sizeof text, "print-%Y%m%dT%H%M%SZ", &utc)};
}

void require_records(Run& run) {
  if (run.scans.empty()) {
    run.printer_words.insert(run.printer_words.end(), {"--set", "calibration.folder="});
    return;
  }
  std::vector<std::string> needs;
  for (const std::string& scan : run.scans) needs.insert(needs.end(), {"--need", scan});
  run.require(check_records(run, needs), run.file("calibration.json"));
}

// From here on the settings are frozen, the calibration in force included.
void freeze_settings(Run& run) {
  const std::string file = run.file("printer.toml");
  if (const int status = freeze_settings(run, file, run.options.accept_printer); status != 0) throw Ended{status};
  run.talk.forget("printer");
  run.require({"printer", {"vam-check", "--seal", file}});
  run.printer = io::load_printer(file, {});
  require_same_settings(run);
  if (run.turns == 0) run.turns = run.options.turns.value_or(run.printer.stage.turns);
  if (!run.printer.stage.device.empty()) return;
  throw Error{Fault::usage,
              "stage.device: no device is set; give it in the printer file, or --set stage.device=DEVICE (sim: is a "
              "simulated stage)"};
}

// The turns for which the sinogram was planned, of a print that is corrected.
void plan_turns(Run& run) {
  const Options& o = run.options;
  run.require({"plan",
               {"vam-dose", o.sinogram, "--like", o.target, "--printer", run.file("printer.toml"), "--report",
                run.file("plan.json"), "-o", "-"}},
              "/dev/null");
  run.planned_turns = number_at(parse_json(text_of(run.file("plan.json"))), "turns");
  if (run.planned_turns <= 0) {
    throw Error{Fault::data, o.sinogram +
                                 ": has no planned exposure; compute it by vam-optimize for a printer with "
                                 "resin.critical_dose_mj_cm3"};
  }
  if (run.turns >= run.planned_turns) return;
  throw Error{Fault::usage, "--turns: is " + std::to_string(run.turns) + ", but the sinogram is planned for " +
                                format_number(run.planned_turns) +
                                "; give more, as a print that is corrected may take longer"};
}

void require_curve(const Run& run) {
  const std::string& record = run.options.resin;
  if (text_of(record).find("vam-working-curve/") == std::string::npos)
    throw Error{Fault::data, record + ": not a record of vam-calibrate working-curve, as --correct requires"};
  (void)io::require_seal(parse_distinct(io::read_all(record), record), record);
}

void ask(Run& run, const std::string& name, const std::string& tool) {
  run.require(identify(name, tool, run.file("printer.toml")), run.file(name + ".json"));
}

// The records belong to these devices.
void require_devices_of_records(Run& run) {
  ask(run, "stage", "vam-stage");
  Json devices{{"stage", parse_json(text_of(run.file("stage.json")))}};
  if (run.options.has_views()) {
    ask(run, "camera", "vam-capture");
    devices["camera"] = parse_json(text_of(run.file("camera.json")));
  }
  io::write_text(run.file("devices.json"), devices.dump() + "\n");
  run.require(check_records(run, {"--devices", run.file("devices.json")}), run.file("calibration.json"));
}

void require_devices_of_resumed(Run& run) {
  const auto has = [&](const char* file) { return fs::is_regular_file(run.frozen + "/" + file); };
  if (has("calibration.json")) fs::copy_file(run.frozen + "/calibration.json", run.file("calibration.json"));
  if (has("stage.json")) {
    ask(run, "stage", "vam-stage");
    require_same_device(run, "stage");
  }
  if (run.options.has_views() && has("camera.json")) {
    ask(run, "camera", "vam-capture");
    require_same_device(run, "camera");
  }
}

// Every device answers and its limits allow the print.
void require_answers(Run& run) {
  const std::string printer = run.file("printer.toml");
  run.require(plan_light(run, printer, run.options.accept_printer));
  run.require(plan_motion(run, printer));
  if (run.options.has_views()) run.require(identify("capture", "vam-capture", printer));
  if (run.options.resume.empty() && run.options.until.empty()) {
    for (const std::string& line : split(run.talk.text("project"), '\n')) {
      if (line.find(" of the planned dose, ") != std::string::npos) pass_on(line);
    }
  }
  for (const char* name : {"project", "stage", "capture"}) run.talk.forget(name);
}

// What the tools need in the folder.
void furnish(const Run& run) {
  constexpr std::size_t reserve = 65536;
  std::ofstream room(run.file(".reserve"), std::ios::binary);
  room << std::string(reserve, '\0') << std::flush;
  if (!room) {
    throw Error{Fault::io,
                run.folder + ": has no room for 64 kB, which the summary of a print needs; free space on the disk"};
  }
  for (const char* name : {".stage", ".project", ".capture", ".views"}) {
    if (mkfifo(run.file(name).c_str(), 0644) != 0)
      throw Error{Fault::no_output, run.file(name) + ": cannot be made; give a --run where pipes can be"};
  }
  std::error_code ignored;
  fs::create_symlink(fs::canonical(run.options.sinogram), run.file("sinogram.exr"), ignored);
}

}  // namespace

void make_folder(Run& run) {
  const auto make = [&](const std::string& name) {
    run.folder = name.starts_with('-') ? "./" + name : name;
    return mkdir(run.folder.c_str(), 0777) == 0;
  };
  const auto refuse = [&](const char* reason) { throw Error{Fault::no_output, run.folder + ": " + reason}; };
  if (!run.options.run.empty()) {
    if (!make(run.options.run))
      refuse(fs::exists(run.folder) ? "exists; give another --run" : "cannot create the folder");
    return;
  }
  const std::string stem = stamp();
  for (int number = 1; !make(stem + (number == 1 ? "" : "-" + std::to_string(number))); ++number) {
    if (!fs::exists(run.folder)) refuse("cannot create the folder");
  }
}

int freeze_settings(Run& run, const std::string& file, bool accept_printer) {
  const int status = run_to_end(freeze(run, file, accept_printer), run.talk.path("printer"));
  bool cut = false;
  for (const std::string& line : split(run.talk.text("printer"), '\n')) {
    constexpr std::string_view warning = "vam-project: warning: ";
    if (!line.starts_with(warning) || line.find(", as if it was cut off") == std::string::npos) continue;
    say(line.substr(warning.size()));
    cut = true;
  }
  if (cut) return data_status;
  run.talk.show("printer");  // what is accepted, too
  return status;
}

int check_metrology(const Run& run, const std::string& printer) {
  if (run.turns < 2) {
    say("--until: requires at least 2 turns, as it judges by a full turn of views of a visible print; there is " +
        std::to_string(run.turns));
    return usage_status;
  }
  const int status = run_to_end(try_metrology(run, printer), run.talk.path("metrology"));
  if (run.talk.text("metrology").find("stdin: is empty") != std::string::npos) return 0;
  run.talk.show("metrology");
  return status;
}

void arm(Run& run) {
  if (run.options.correct) require_curve(run);
  require_records(run);
  freeze_settings(run);
  if (!run.options.until.empty()) {
    const int status = check_metrology(run, run.file("printer.toml"));
    run.talk.forget("metrology");
    if (status != 0) throw Ended{status};
  }
  if (run.options.correct) {
    plan_turns(run);
    fs::create_directory(run.file("renewed"));
  }
  if (!run.scans.empty()) require_devices_of_records(run);
  if (!run.frozen.empty()) require_devices_of_resumed(run);
  require_answers(run);
  furnish(run);
  Json facts{{"turns", run.turns}, {"from_deg", run.from_deg}, {"sinogram_sha256", run.sinogram_sha256}};
  if (!run.options.resume.empty()) {
    facts["resumes"] = run.options.resume;
    facts["resumes_utc"] = armed_utc(run.options.resume);
  }
  run.note("armed", facts);
}

}  // namespace vam::print_tool
