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
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "vam-print/commands.hpp"
#include "vam-print/resume.hpp"

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

std::string name_of(const Json& identity) {
  std::string name;
  for (const char* key : {"maker", "model", "serial"}) {
    if (const std::string text = text_at(identity, key); !text.empty()) name += text + " ";
  }
  return name;
}

/// The steps of arming. The first that fails ends it; a plan tells of each in a row, and goes on.
class Steps {
 public:
  explicit Steps(Run& run) : run_(run), plan_(run.options.plan), printer_(run.file("printer.toml")) {}

  void take() {
    row("sinogram", run_.options.sinogram);
    if (run_.options.correct && !plan_) require_curve();
    records();
    settings();
    metrology();  // wrong options, before a device is asked
    if (run_.options.correct && !plan_) plan_turns();
    light();
    motion();
    if (run_.options.has_views()) identify_device("camera", "vam-capture", run_.printer.camera.device);
    devices();
  }
  void disk();
  [[nodiscard]] int worst() const { return worst_; }

 private:
  void row(std::string name, const std::string& text) const;
  bool attempt(const std::string& name, const std::function<void()>& body);
  std::string ask(const Command& command, const std::string& output = "");
  void require_curve() const;
  void records();
  void settings();
  void freeze_settings();
  void plan_turns();
  void light();
  void motion();
  bool identify_device(const std::string& name, const std::string& tool, const std::string& address);
  void devices();
  void metrology();

  Run& run_;
  bool plan_;
  std::string printer_;
  Json devices_ = Json::object();
  int worst_ = 0;
};

void Steps::row(std::string name, const std::string& text) const {
  if (!plan_) return;
  constexpr std::size_t column = 11;
  name.append(name.size() < column ? column - name.size() : 1, ' ');
  std::printf("%s%s\n", name.c_str(), text.c_str());
}

// False, with a row that says so, where the body has said why it fails.
bool Steps::attempt(const std::string& name, const std::function<void()>& body) {
  int status = 0;
  try {
    body();
    return true;
  } catch (const Error& error) {
    if (!plan_) throw;
    say(error.what());
    status = static_cast<int>(error.fault);
  } catch (const Ended& ended) {
    if (!plan_) throw;
    status = ended.status;
  }
  row(name, "failed");
  if (worst_ == 0) worst_ = status;
  return false;
}

// What a command prints; in a plan, what it says is shown, but what is accepted was said with the settings.
std::string Steps::ask(const Command& command, const std::string& output) {
  run_.talk.forget(command.name);
  std::string printed = run_.require(command, output);
  if (plan_) run_.talk.show(command.name, [](const std::string& line) { return !line.ends_with("; accepted"); });
  return printed;
}

void Steps::require_curve() const {
  const std::string& record = run_.options.resin;
  if (text_of(record).find("vam-working-curve/") == std::string::npos)
    throw Error{Fault::data, record + ": not a record of vam-calibrate working-curve, as --correct requires"};
  (void)io::require_seal(parse_distinct(io::read_all(record), record), record);
}

void Steps::records() {
  std::vector<std::string> needs;
  for (const std::string& scan : run_.scans) needs.insert(needs.end(), {"--need", scan});
  std::string printed;
  if (needs.empty()) row("records", run_.frozen.empty() ? "none used" : "as in " + run_.frozen + "/printer.toml");
  if (needs.empty() ||
      !attempt("records", [&] { printed = ask(check_records(run_, needs), run_.file("calibration.json")); })) {
    run_.scans.clear();
    run_.printer_words.insert(run_.printer_words.end(), {"--set", "calibration.folder="});
    return;
  }
  const Json found = parse_json(printed);
  for (const auto& [scan, record] : found.items()) {
    if (!record.is_object()) continue;
    constexpr double hour_s = 3600;
    const double age_h = (utc_seconds() - parse_utc(text_at(record, "utc"), scan)) / hour_s;
    row("record", scan + ": " + text_at(record, "status") + ", " + fixed_number(age_h, 1) + " h old, valid until " +
                      text_at(record, "valid_until"));
  }
}

// From here on the settings are frozen, the calibration in force included.
void Steps::settings() {
  if (!attempt("settings", [&] { freeze_settings(); }) &&
      run_to_end(freeze(run_, printer_, true), run_.talk.path("again")) != 0) {
    throw Ended{worst_};
  }
  ask({"seal", {"vam-check", "--seal", printer_}});
  run_.printer = io::load_printer(printer_, {});
  attempt("resumption", [&] { require_same_settings(run_); });
  if (run_.turns == 0) run_.turns = run_.options.turns.value_or(run_.printer.stage.turns);
}

// Those of a file that may have been cut off are refused; what is accepted is said.
void Steps::freeze_settings() {
  const int status = run_to_end(freeze(run_, printer_, run_.options.accept_printer), run_.talk.path("printer"));
  for (const std::string& line : split(run_.talk.text("printer"), '\n')) {
    constexpr std::string_view warning = "vam-project: warning: ";
    if (line.starts_with(warning) && line.find(", as if it was cut off") != std::string::npos)
      throw Error{Fault::data, line.substr(warning.size())};
  }
  run_.talk.show("printer");
  if (status != 0) throw Ended{status};
}

// vam-ost refuses wrong options before it misses the views, of which it gets none here.
void Steps::metrology() {
  if (run_.options.until.empty()) return;
  attempt("metrology", [&] {
    if (run_.turns < 2) {
      throw Error{Fault::usage,
                  "--until: requires at least 2 turns, as it judges by a full turn of views of a visible print; there "
                  "is " +
                      std::to_string(run_.turns)};
    }
    const int status = run_to_end(try_metrology(run_, printer_), run_.talk.path("metrology"));
    if (run_.talk.text("metrology").find("stdin: is empty") != std::string::npos) return;
    run_.talk.show("metrology");
    if (status != 0) throw Ended{status};
  });
}

// The turns for which the sinogram was planned, of a print that is corrected.
void Steps::plan_turns() {
  const Options& o = run_.options;
  ask({"plan",
       {"vam-dose", o.sinogram, "--like", o.target, "--printer", printer_, "--report", run_.file("plan.json"), "-o",
        "-"}},
      "/dev/null");
  run_.planned_turns = number_at(parse_json(text_of(run_.file("plan.json"))), "turns");
  if (run_.planned_turns <= 0) {
    throw Error{Fault::data, o.sinogram +
                                 ": has no planned exposure; compute it by vam-optimize for a printer with "
                                 "resin.critical_dose_mj_cm3"};
  }
  if (run_.turns < run_.planned_turns) {
    throw Error{Fault::usage, "--turns: is " + std::to_string(run_.turns) + ", but the sinogram is planned for " +
                                  format_number(run_.planned_turns) +
                                  "; give more, as a print that is corrected may take longer"};
  }
  fs::create_directory(run_.file("renewed"));
}

void Steps::light() {
  attempt("projector", [&] {
    const std::string printed = ask(plan_light(run_, printer_));
    if (plan_) return (void)std::fputs(printed.c_str(), stdout);
    if (!run_.options.resume.empty() || !run_.options.until.empty()) return;
    run_.talk.show("project",
                   [](const std::string& line) { return line.find(" of the planned dose, ") != std::string::npos; });
  });
}

void Steps::motion() {
  if (!identify_device("stage", "vam-stage", run_.printer.stage.device)) return;
  attempt("motion", [&] { row("motion", trimmed(ask(plan_motion(run_, printer_)), "\n")); });
}

// Records belong to their devices, and the rest of a print to those of its beginning.
bool Steps::identify_device(const std::string& name, const std::string& tool, const std::string& address) {
  return attempt(name, [&] {
    if (name == "stage" && address.empty()) {
      throw Error{Fault::usage,
                  "stage.device: no device is set; give it in the printer file, or --set stage.device=DEVICE (sim: is "
                  "a simulated stage)"};
    }
    const std::string printed = ask(identify(name, tool, printer_));
    const Json identity = parse_json(printed);
    devices_[name] = identity;
    row(name, address + " " + name_of(identity));
    const bool resumed = !run_.frozen.empty() && fs::is_regular_file(run_.frozen + "/" + name + ".json");
    if (resumed || !run_.scans.empty()) io::write_text(run_.file(name + ".json"), printed);
    if (resumed) require_same_device(run_, name);
  });
}

void Steps::devices() {
  const std::string records = run_.file("calibration.json");
  if (!run_.frozen.empty() && fs::is_regular_file(run_.frozen + "/calibration.json"))
    fs::copy_file(run_.frozen + "/calibration.json", records);
  if (run_.scans.empty() || !devices_.contains("stage")) return;
  const std::string file = run_.file("devices.json");
  io::write_text(file, devices_.dump() + "\n");
  attempt("devices", [&] { ask(check_records(run_, {"--devices", file}), records); });
}

void Steps::disk() {
  const std::string parent = fs::path(run_.options.run).parent_path().string();
  const std::string folder = parent.empty() ? "." : parent;
  attempt("disk", [&] {
    struct statvfs about = {};
    if (statvfs(folder.c_str(), &about) != 0)
      throw Error{Fault::no_output, folder + ": no such folder; create it for --run"};
    constexpr double gb = 1e9;
    const double free_gb = static_cast<double>(about.f_bavail) * static_cast<double>(about.f_frsize) / gb;
    row("disk", fixed_number(free_gb, 1) + " GB free in " + fs::canonical(folder).string() + " for the run folder");
  });
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
  Steps(run).take();
  run.talk.forget();
  furnish(run);
  Json facts{{"turns", run.turns}, {"from_deg", run.from_deg}, {"sinogram_sha256", run.sinogram_sha256}};
  if (!run.options.resume.empty()) {
    facts["resumes"] = run.options.resume;
    facts["resumes_utc"] = armed_utc(run.options.resume);
  }
  run.note("armed", facts);
}

int print_plan(Run& run) {
  run.folder = run.talk.folder();
  Steps steps(run);
  steps.take();
  steps.disk();
  if (!run.options.commands) return steps.worst();
  run.folder = run.options.run.empty() ? "run" : run.options.run;
  for (const std::string& line : lines_by_hand(run)) std::printf("%s\n", line.c_str());
  return steps.worst();
}

}  // namespace vam::print_tool
