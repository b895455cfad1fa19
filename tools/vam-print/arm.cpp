// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-print/arm.hpp"

#include <sys/stat.h>
#include <sys/statvfs.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/run_folder.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "vam-print/commands.hpp"

namespace vam::print_tool {

namespace {

namespace fs = std::filesystem;

std::string stamp() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  return {text, std::strftime(text, sizeof text, "print-%Y%m%dT%H%M%SZ", &utc)};
}

/// The steps of arming. The first that fails ends it; a plan tells of each in a row, and goes on.
struct Steps {
  Run& run;
  bool plan = run.options.plan;
  std::string printer = run.file("printer.toml");
  Json devices = Json::object();
  int worst = 0;

  void row(std::string name, const std::string& text) const {
    if (!plan) return;
    constexpr std::size_t column = 11;
    name.append(name.size() < column ? column - name.size() : 1, ' ');
    std::printf("%s%s\n", name.c_str(), text.c_str());
  }

  // False, with a row that says so, where the body has said why it fails.
  bool attempt(const std::string& name, const std::function<void()>& body) {
    int status = 0;
    try {
      body();
      return true;
    } catch (const Error& error) {
      if (!plan) throw;
      say(error.what());
      status = static_cast<int>(error.fault);
    } catch (const Ended& ended) {
      if (!plan) throw;
      status = ended.status;
    }
    row(name, "failed");
    if (worst == 0) worst = status;
    return false;
  }

  // What a command prints; in a plan, what it says is shown, but what is accepted was said with the settings.
  std::string ask(const Command& command, const std::string& output = "") const {
    run.talk.forget(command.name);
    std::string printed = run.require(command, output);
    if (plan) run.talk.show(command.name, [](const std::string& line) { return !line.ends_with("; accepted"); });
    return printed;
  }
};

void require_curve(const std::string& record) {
  if (text_of(record).find("vam-working-curve/") == std::string::npos)
    throw Error{Fault::data, record + ": not a record of vam-calibrate working-curve, as --correct requires"};
  (void)io::require_seal(parse_distinct(io::read_all(record), record), record);
}

void take_records(Steps& steps) {
  Run& run = steps.run;
  std::vector<std::string> needs;
  for (const std::string& scan : run.scans) needs.insert(needs.end(), {"--need", scan});
  std::string printed;
  if (needs.empty()) steps.row("records", run.frozen.empty() ? "none used" : "as in " + run.frozen + "/printer.toml");
  if (needs.empty() || !steps.attempt("records", [&] {
        printed = steps.ask(check_records(run, needs), run.file("calibration.json"));
      })) {
    run.scans.clear();
    run.printer_words.insert(run.printer_words.end(), {"--set", "calibration.folder="});
    return;
  }
  const Json found = parse_json(printed);
  for (const auto& [scan, record] : found.items()) {
    if (!record.is_object()) continue;
    constexpr double hour_s = 3600;
    const double age_h = (utc_seconds() - parse_utc(text_at(record, "utc"), scan)) / hour_s;
    steps.row("record", scan + ": " + text_at(record, "status") + ", " + fixed_number(age_h, 1) +
                            " h old, valid until " + text_at(record, "valid_until"));
  }
}

// Those of a file that may have been cut off are refused; what is accepted is said.
void freeze_settings(Steps& steps) {
  Run& run = steps.run;
  const int status = run_to_end(freeze(run, steps.printer, run.options.accept_printer), run.talk.path("printer"));
  for (const std::string& line : split(run.talk.text("printer"), '\n')) {
    constexpr std::string_view warning = "vam-project: warning: ";
    if (line.starts_with(warning) && line.find(", as if it was cut off") != std::string::npos)
      throw Error{Fault::data, line.substr(warning.size())};
  }
  run.talk.show("printer");
  if (status != 0) throw Ended{status};
}

// From here on the settings are frozen, the calibration in force included.
void take_settings(Steps& steps) {
  Run& run = steps.run;
  if (!steps.attempt("settings", [&] { freeze_settings(steps); }) &&
      run_to_end(freeze(run, steps.printer, true), run.talk.path("again")) != 0) {
    throw Ended{steps.worst};
  }
  steps.ask({"seal", {"vam-check", "--seal", steps.printer}});
  run.printer = io::load_printer(steps.printer, {});
  steps.attempt("resumption", [&] { require_same_settings(run); });
  if (run.turns == 0) run.turns = run.options.turns.value_or(run.printer.stage.turns);
}

// vam-ost refuses wrong options before it misses the views, of which it gets none here.
void check_metrology(Steps& steps) {
  Run& run = steps.run;
  if (run.options.until.empty()) return;
  steps.attempt("metrology", [&] {
    if (run.turns < 2) {
      throw Error{Fault::usage,
                  "--until: requires at least 2 turns, as it judges by a full turn of views of a visible print; there "
                  "is " +
                      std::to_string(run.turns)};
    }
    const int status = run_to_end(try_metrology(run, steps.printer), run.talk.path("metrology"));
    if (run.talk.text("metrology").find("stdin: is empty") != std::string::npos) return;
    run.talk.show("metrology");
    if (status != 0) throw Ended{status};
  });
}

// The turns for which the sinogram was planned, of a print that is corrected.
void plan_turns(Steps& steps) {
  Run& run = steps.run;
  const Options& o = run.options;
  steps.ask({"plan",
             {"vam-dose", o.sinogram, "--like", o.target, "--printer", steps.printer, "--report", run.file("plan.json"),
              "-o", "-"}},
            "/dev/null");
  run.planned_turns = number_at(parse_json(text_of(run.file("plan.json"))), "turns");
  if (run.planned_turns <= 0) {
    throw Error{Fault::data, o.sinogram +
                                 ": has no planned exposure; compute it by vam-optimize for a printer with "
                                 "resin.critical_dose_mj_cm3"};
  }
  if (run.turns < run.planned_turns) {
    throw Error{Fault::usage, "--turns: is " + std::to_string(run.turns) + ", but the sinogram is planned for " +
                                  format_number(run.planned_turns) +
                                  "; give more, as a print that is corrected may take longer"};
  }
  fs::create_directory(run.file("renewed"));
}

void check_light(Steps& steps) {
  Run& run = steps.run;
  steps.attempt("projector", [&] {
    const std::string printed = steps.ask(plan_light(run, steps.printer));
    if (steps.plan) return (void)std::fputs(printed.c_str(), stdout);
    if (!run.options.resume.empty() || !run.options.until.empty()) return;
    run.talk.show("project",
                  [](const std::string& line) { return line.find(" of the planned dose, ") != std::string::npos; });
  });
}

// Records belong to their devices, and the rest of a print to those of its beginning.
bool identify_device(Steps& steps, const std::string& name, const std::string& tool, const std::string& address) {
  Run& run = steps.run;
  return steps.attempt(name, [&] {
    if (name == "stage" && address.empty()) {
      throw Error{Fault::usage,
                  "stage.device: no device is set; give it in the printer file, or --set stage.device=DEVICE (sim: is "
                  "a simulated stage)"};
    }
    const std::string printed = steps.ask(identify(name, tool, steps.printer));
    const Json identity = parse_json(printed);
    steps.devices[name] = identity;
    steps.row(name, address + " " + io::device_name(identity));
    const bool resumed = !run.frozen.empty() && fs::is_regular_file(run.frozen + "/" + name + ".json");
    if (resumed || !run.scans.empty()) io::write_text(run.file(name + ".json"), printed);
    if (resumed) require_same_device(run, name);
  });
}

void check_motion(Steps& steps) {
  const Run& run = steps.run;
  if (!identify_device(steps, "stage", "vam-stage", run.printer.stage.device)) return;
  steps.attempt("motion", [&] { steps.row("motion", trimmed(steps.ask(plan_motion(run, steps.printer)), "\n")); });
}

void check_devices(Steps& steps) {
  Run& run = steps.run;
  const std::string records = run.file("calibration.json");
  if (!run.frozen.empty() && fs::is_regular_file(run.frozen + "/calibration.json"))
    fs::copy_file(run.frozen + "/calibration.json", records);
  if (run.scans.empty() || !steps.devices.contains("stage")) return;
  const std::string file = run.file("devices.json");
  io::write_text(file, steps.devices.dump() + "\n");
  steps.attempt("devices", [&] { steps.ask(check_records(run, {"--devices", file}), records); });
}

void check_disk(Steps& steps) {
  const std::string parent = fs::path(steps.run.options.run).parent_path().string();
  const std::string folder = parent.empty() ? "." : parent;
  steps.attempt("disk", [&] {
    struct statvfs about = {};
    if (statvfs(folder.c_str(), &about) != 0)
      throw Error{Fault::no_output, folder + ": no such folder; create it for --run"};
    constexpr double gb = 1e9;
    const double free_gb = static_cast<double>(about.f_bavail) * static_cast<double>(about.f_frsize) / gb;
    steps.row("disk",
              fixed_number(free_gb, 1) + " GB free in " + fs::canonical(folder).string() + " for the run folder");
  });
}

void take(Steps& steps) {
  Run& run = steps.run;
  steps.row("sinogram", run.options.sinogram);
  if (run.options.correct && !steps.plan) require_curve(run.options.resin);
  take_records(steps);
  take_settings(steps);
  check_metrology(steps);  // wrong options, before a device is asked
  if (run.options.correct && !steps.plan) plan_turns(steps);
  check_light(steps);
  check_motion(steps);
  if (run.options.has_views()) identify_device(steps, "camera", "vam-capture", run.printer.camera.device);
  check_devices(steps);
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
  for (const char* name : pipes) {
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

void arm(Run& run) {
  Steps steps{run};
  take(steps);
  run.talk.forget();
  furnish(run);
  Json facts{{"turns", run.turns}, {"from_deg", run.from_deg}, {"sinogram_sha256", run.sinogram_sha256}};
  if (!run.options.resume.empty()) {
    facts["resumes"] = run.options.resume;
    facts["resumes_utc"] = run.resumed_utc;
  }
  run.note("armed", facts);
}

int print_plan(Run& run) {
  const device::TemporaryFolder plan;
  run.folder = plan.path();
  Steps steps{run};
  take(steps);
  check_disk(steps);
  if (!run.options.commands) return steps.worst;
  run.folder = run.options.run.empty() ? "run" : run.options.run;
  for (const std::string& line : lines_by_hand(run)) std::printf("%s\n", line.c_str());
  return steps.worst;
}

}  // namespace vam::print_tool
