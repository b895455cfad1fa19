// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-print/commands.hpp"

#include <fcntl.h>
#include <unistd.h>

#include "base/text/figure_text.hpp"
#include "base/text/text.hpp"
#include "cli/app.hpp"

namespace vam::print_tool {

namespace {

using Words = std::vector<std::string>;

constexpr int most_digits = 12;

std::string text(double number) { return format_number(number, most_digits); }

void add(Words& words, const Words& more) { words.insert(words.end(), more.begin(), more.end()); }
void add_given(Words& words, const char* flag, const std::string& value) {
  if (!value.empty()) add(words, {flag, value});
}

// What vam-project needs to know of a print, to plan it as to show it.
void add_exposure(Words& words, const Run& run, const std::string& printer, bool accept_printer) {
  const Options& o = run.options;
  add(words, {o.sinogram, "-o", o.display, "--printer", printer, "--turns", std::to_string(run.turns), "--from",
              fixed_number(run.from_deg, 4)});
  if (accept_printer) add(words, {"--accept-printer"});
  if (o.accept_dose) add(words, {"--accept-dose"});
  add_given(words, "--light", o.light);
  if (o.frames_per_turn) add(words, {"--frames-per-turn", std::to_string(*o.frames_per_turn)});
}

void add_motion(Words& words, const Run& run, const std::string& printer) {
  add(words,
      {"--printer", printer, "--turns", std::to_string(all_turns(run)), "--run-up", text(run.options.run_up_turns)});
  if (run.options.home) add(words, {"--home"});
}

Words metrology(const Run& run, const std::string& printer) {
  const Options& o = run.options;
  Words words{"vam-ost", "-", "--live", "--until", o.until};
  add_given(words, "--target", o.target);
  add_given(words, "--isovalue", o.isovalue);
  add_given(words, "--resin", o.resin);
  add(words, {"--printer", printer});
  return words;
}

Command project(const Run& run) {
  Words words{"vam-project"};
  add_exposure(words, run, run.file("printer.toml"), run.options.accept_printer);
  if (run.options.correct) add(words, {"--frames-from", run.file("renewed")});
  add(words, {"--follow", run.file(".project"), "--max-missed", text(run.options.max_missed), "--max-missed-lit",
              text(run.options.max_missed_lit), "--log", run.file("flips.jsonl"), "--report", run.file("project.json"),
              "--die-with-parent"});
  return {"project", words};
}

Command capture(const Run& run) {
  const Options& o = run.options;
  Words words{"vam-capture",
              "--printer",
              run.file("printer.toml"),
              "--follow",
              run.file(".capture"),
              "--view-step",
              text(*o.view_step_deg),
              "--turns",
              std::to_string(all_turns(run)),
              "--log",
              run.file("capture.jsonl"),
              "--report",
              run.file("capture.json"),
              "--die-with-parent"};
  if (o.until.empty()) {
    add(words, {"-o", run.file("views/")});
    return {"capture", words};
  }
  if (o.page) add(words, {"--latest", run.file("camera.png")});
  add(words, {"--live"});
  return {"capture", words, {{STDOUT_FILENO, run.file(".views"), O_WRONLY}}};
}

Command ost(const Run& run) {
  Words words = metrology(run, run.file("printer.toml"));
  add(words, {"--log", run.file("ost.jsonl"), "-o", run.file("ost")});
  return {"ost",
          words,
          {{STDIN_FILENO, run.file(".views"), O_RDONLY},
           {STDOUT_FILENO, run.file("stop.json"), O_WRONLY | O_CREAT | O_TRUNC}}};
}

// The angles to everybody: first their readers are there, then the stage is waited for. A tool of the system, which
// writes a line to the log before anybody has it, and ends with its input alone.
Command lines(const Run& run) {
  Command tee{"lines", {"tee", "-p", "/dev/fd/4"}, {{4, run.file(".project"), O_WRONLY}}};
  if (run.options.has_views()) {
    tee.words.emplace_back("/dev/fd/5");
    tee.files.push_back({5, run.file(".capture"), O_WRONLY});
  }
  tee.files.push_back({STDIN_FILENO, run.file(".stage"), O_RDONLY});
  tee.files.push_back({STDOUT_FILENO, run.file("angles.jsonl"), O_WRONLY | O_CREAT | O_TRUNC});
  return tee;
}

Command stage(const Run& run) {
  Words words{"vam-stage", "spin"};
  add_motion(words, run, run.file("printer.toml"));
  add(words, {"--log", run.file("stage.jsonl"), "--die-with-parent"});
  return {"stage", words, {{STDOUT_FILENO, run.file(".stage"), O_WRONLY}}};
}

std::string line_of(const Command& command) {
  std::string line;
  for (const std::string& word : command.words) line += (line.empty() ? "" : " ") + cli::quoted(word);
  for (const Redirection& file : command.files) {
    const bool standard = file.descriptor <= STDOUT_FILENO;
    line += " " + (standard ? "" : std::to_string(file.descriptor)) + ((file.flags & O_WRONLY) != 0 ? ">" : "<") +
            cli::quoted(file.path);
  }
  return line;
}

}  // namespace

std::vector<std::string> lines_by_hand(const Run& run) {
  const std::string settings = run.file("printer.toml");
  Words lines{"mkdir " + cli::quoted(run.folder)};
  if (run.options.correct) lines.push_back("mkdir " + cli::quoted(run.file("renewed")));
  lines.push_back(line_of(freeze(run, settings, run.options.accept_printer)));
  lines.push_back("vam-check --seal " + cli::quoted(settings));
  std::string make = "mkfifo";
  for (const char* name : pipes) make += " " + cli::quoted(run.file(name));
  lines.push_back(make);
  for (const Command& tool : tools_of(run)) lines.push_back(line_of(tool) + " &");
  if (run.options.correct) lines.push_back(line_of(renew(run)) + " &");
  lines.emplace_back("wait");
  return lines;
}

int all_turns(const Run& run) { return run.turns + run.options.dark_turns; }

Command check_records(const Run& run, const std::vector<std::string>& more) {
  Words words{"vam-calibrate", "check"};
  add(words, run.printer_words);
  add(words, more);
  return {"check", words};
}

Command freeze(const Run& run, const std::string& file, bool accept_printer) {
  Words words{"vam-project", run.options.sinogram, "--freeze", file};
  add(words, run.printer_words);
  if (accept_printer) add(words, {"--accept-printer"});
  return {"printer", words};
}

Command identify(const std::string& name, const std::string& tool, const std::string& printer) {
  return {name, {tool, "identify", "--printer", printer}};
}

Command plan_light(const Run& run, const std::string& printer) {
  Words words{"vam-project"};
  add_exposure(words, run, printer, true);  // the settings were judged
  add(words, {"--plan"});
  return {"project", words};
}

Command plan_motion(const Run& run, const std::string& printer) {
  Words words{"vam-stage", "spin", "--plan"};
  add_motion(words, run, printer);
  return {"stage", words};
}

Command try_metrology(const Run& run, const std::string& printer) { return {"ost", metrology(run, printer)}; }

std::vector<Command> tools_of(const Run& run) {
  std::vector<Command> all{project(run)};
  if (run.options.has_views()) all.push_back(capture(run));
  if (!run.options.until.empty()) all.push_back(ost(run));
  all.push_back(lines(run));
  all.push_back(stage(run));
  return all;
}

Command renew(const Run& run) {
  const Options& o = run.options;
  return {"renew",
          {"vam-correct", "renew", run.folder, "--target", o.target, "--curve", o.resin, "--axis-sigma",
           text(o.axis_sigma_px)}};
}

Command watch(const Run& run) {
  Words words{"vam-status", run.folder, "--watch", "--interval", "2", "--threads", "1", "--die-with-parent"};
  if (run.options.page) add(words, {"--page", run.file("page.html")});
  return {"watch", words};
}

}  // namespace vam::print_tool
