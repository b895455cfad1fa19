// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-print/run.hpp"

#include <fcntl.h>
#include <unistd.h>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "io/stream/stream.hpp"

namespace vam::print_tool {

Run::Run(const Options& given)
    : options(given),
      begun(utc_text(utc_seconds())),
      scans(needed_scans(given)),
      sinogram_sha256(io::sha256_of(given.sinogram)) {
  if (options.sinogram.starts_with('-')) options.sinogram = "./" + options.sinogram;  // a name, for all tools
  if (!options.printer.file.empty()) printer_words = {"--printer", options.printer.file};
  for (const std::string& setting : options.printer.sets) printer_words.insert(printer_words.end(), {"--set", setting});
  // The rest of a print, or one that ends by what the camera sees, has turns that are no plan.
  if (!options.resume.empty() || !options.until.empty()) options.accept_dose = true;
}

void Run::look() {
  if (light_lost_) return;
  try {
    if (!light && !has_regular_file(file("flips.jsonl"))) return;
    if (!light) light.emplace(folder);
    light->read();
  } catch (const Error&) {
    light_lost_ = true;
  }
}

double Run::turns_shown() const { return light && !light->flips().empty() ? light->flips().back().angle_deg / 360 : 0; }

void Run::note(const std::string& event) { note(event, Json::object()); }

void Run::note(const std::string& event, const Json& facts) {
  try {
    if (!events_) {
      auto events = std::make_unique<device::EventLog>(file("events.jsonl"), FormatKind("vam-print"));
      lock = events->hold();
      events_ = std::move(events);
    }
    (*events_)(event, facts);
  } catch (const Error&) {
    if (lock < 0) throw;  // nothing is in use yet
    // The disk is full, or gone: that is what ends the print, and what is reported.
  }
}

void Run::keep_events() {
  try {
    if (events_) events_->sync();
  } catch (const Error&) {  // as above
  }
}

std::string Run::require(const Command& command, const std::string& output) {
  const std::string printed = output.empty() ? talk.path("printed") : output;
  Command whole = command;
  whole.files.push_back({STDOUT_FILENO, printed, O_WRONLY | O_CREAT | O_TRUNC});
  if (const int status = run_to_end(whole, talk.path(command.name)); status != 0) fail(command.name, status);
  return text_of(printed);
}

void Run::fail(const std::string& tool, int status) const {
  std::vector<std::string> lines = split(trimmed(talk.text(tool), "\n"), '\n');
  std::erase_if(lines, [](const std::string& line) { return line.empty() || line.ends_with("; accepted"); });
  if (lines.empty()) lines.push_back("vam-print: " + tool + " ended with status " + std::to_string(status));
  for (std::string& line : lines) {
    if (line.starts_with("tee:")) {
      line = "vam-print: " + file("angles.jsonl") + ": cannot be written: " + line.substr(line.rfind(": ") + 2);
    }
    pass_on(line);
  }
  throw Ended{status};
}

}  // namespace vam::print_tool
