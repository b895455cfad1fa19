// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-print/plan.hpp"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <functional>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/stream.hpp"
#include "vam-print/arm.hpp"
#include "vam-print/commands.hpp"
#include "vam-print/resume.hpp"

namespace vam::print_tool {

namespace {

namespace fs = std::filesystem;

class Plan {
 public:
  explicit Plan(Run& run) : run_(run) { run.folder = run.talk.folder(); }

  int print() {
    row("sinogram", run_.options.sinogram);
    records();
    settings();
    light();
    motion();
    camera();
    if (!run_.scans.empty() && !stage_.is_null()) devices();
    if (!run_.options.until.empty()) attempt("metrology", [&] { return check_metrology(run_, printer_); });
    disk();
    if (run_.options.commands) commands();
    return worst_;
  }

 private:
  void row(std::string name, const std::string& text) {
    constexpr std::size_t column = 11;
    name.append(name.size() < column ? column - name.size() : 1, ' ');
    std::printf("%s%s\n", name.c_str(), text.c_str());
  }

  /// False, with a row that says so, where the body has said why it fails.
  bool attempt(const std::string& name, const std::function<int()>& body) {
    int status = 0;
    try {
      status = body();
    } catch (const Error& error) {
      say(error.what());
      status = static_cast<int>(error.fault);
    } catch (const Ended& ended) {
      status = ended.status;
    }
    if (status == 0) return true;
    row(name, "failed");
    if (worst_ == 0) worst_ = status;
    return false;
  }

  /// What a command prints; what it says is shown, whatever its status.
  bool attempt(const std::string& name, const Command& command, std::string& printed) {
    return attempt(name, [&] {
      Command whole = command;
      const std::string output = run_.talk.folder() + "/printed";
      whole.files.push_back({STDOUT_FILENO, output, O_WRONLY | O_CREAT | O_TRUNC});
      run_.talk.forget(command.name);
      const int status = run_to_end(whole, run_.talk.path(command.name));
      for (const std::string& line : split(trimmed(run_.talk.text(command.name), "\n"), '\n')) {
        if (!line.ends_with("; accepted")) pass_on(line);
      }
      printed = text_of(output);
      return status;
    });
  }

  void records() {
    if (run_.scans.empty()) {
      row("records", run_.frozen.empty() ? "none used" : "as in " + run_.frozen + "/printer.toml");
      run_.printer_words.insert(run_.printer_words.end(), {"--set", "calibration.folder="});
      return;
    }
    std::vector<std::string> needs;
    for (const std::string& scan : run_.scans) needs.insert(needs.end(), {"--need", scan});
    std::string printed;
    if (!attempt("records", check_records(run_, needs), printed)) {
      run_.scans.clear();
      run_.printer_words.insert(run_.printer_words.end(), {"--set", "calibration.folder="});
      return;
    }
    const Json found = parse_json(printed);
    for (const auto& [scan, record] : found.items()) {
      if (!record.is_object()) continue;
      const std::string utc = text_at(record, "utc");
      constexpr double hour_s = 3600;
      row("record", scan + ": " + text_at(record, "status") + ", " +
                        fixed_number((utc_seconds() - parse_utc(utc, scan)) / hour_s, 1) + " h old, valid until " +
                        text_at(record, "valid_until"));
    }
  }

  void settings() {
    const bool sound =
        attempt("settings", [&] { return freeze_settings(run_, printer_, run_.options.accept_printer); });
    if (!sound && run_to_end(freeze(run_, printer_, true), run_.talk.path("again")) != 0) throw Ended{worst_};
    run_.printer = io::load_printer(printer_, {});
    attempt("resumption", [&] {
      require_same_settings(run_);
      return 0;
    });
    if (run_.turns == 0) run_.turns = run_.options.turns.value_or(run_.printer.stage.turns);
  }

  void light() {
    std::string printed;
    if (attempt("projector", plan_light(run_, printer_, true), printed)) std::fputs(printed.c_str(), stdout);
  }

  void motion() {
    std::string printed;
    if (!attempt("stage", identify("stage", "vam-stage", printer_), printed)) return;
    stage_ = parse_json(printed);
    row("stage", run_.printer.stage.device + " " + name_of(stage_));
    if (attempt("motion", plan_motion(run_, printer_), printed)) row("motion", trimmed(printed, "\n"));
  }

  void camera() {
    std::string printed;
    if (!run_.options.has_views() || !attempt("camera", identify("camera", "vam-capture", printer_), printed)) return;
    camera_ = parse_json(printed);
    row("camera", run_.printer.camera.device + " " + name_of(camera_));
  }

  // The records belong to these devices.
  void devices() {
    Json both{{"stage", stage_}};
    if (!camera_.is_null()) both["camera"] = camera_;
    const std::string file = run_.file("devices.json");
    io::write_text(file, both.dump());
    std::string printed;
    attempt("devices", check_records(run_, {"--devices", file}), printed);
  }

  void disk() {
    const std::string parent = fs::path(run_.options.run).parent_path().string();
    const std::string folder = parent.empty() ? "." : parent;
    struct statvfs about = {};
    const bool known = attempt("disk", [&] {
      if (statvfs(folder.c_str(), &about) == 0) return 0;
      throw Error{Fault::no_output, folder + ": no such folder; create it for --run"};
    });
    if (!known) return;
    constexpr double gb = 1e9;
    const double free_gb = static_cast<double>(about.f_bavail) * static_cast<double>(about.f_frsize) / gb;
    row("disk", fixed_number(free_gb, 1) + " GB free in " + fs::canonical(folder).string() + " for the run folder");
  }

  void commands() {
    run_.folder = run_.options.run.empty() ? "run" : run_.options.run;
    for (const std::string& line : lines_by_hand(run_)) std::printf("%s\n", line.c_str());
  }

  static std::string name_of(const Json& identity) {
    std::string name;
    for (const char* key : {"maker", "model", "serial"}) {
      if (const std::string text = text_at(identity, key); !text.empty()) name += text + " ";
    }
    return name;
  }

  Run& run_;
  std::string printer_ = run_.talk.folder() + "/printer.toml";
  Json stage_, camera_;
  int worst_ = 0;
};

}  // namespace

int print_plan(Run& run) { return Plan(run).print(); }

}  // namespace vam::print_tool
