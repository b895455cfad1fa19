// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "device/os/log_keeper.hpp"
#include "io/settings/flip_log.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/run_folder.hpp"
#include "vam-print/arm.hpp"

namespace vam::print_tool {

namespace {

namespace fs = std::filesystem;

constexpr double turn_deg = 360;

void require_over(const std::string& folder) {
  constexpr int tries = 20;
  constexpr useconds_t pause_us = 50000;
  for (int i = 0; io::is_printed(folder); ++i) {
    if (i == tries) throw Error{Fault::busy, folder + ": is still being printed; stop that print, or wait for its end"};
    usleep(pause_us);
  }
}

void require_not_resumed(const std::string& folder) {
  if (!fs::exists(fs::symlink_status(folder + "/resumed.json"))) return;
  const std::string by = io::resumed_by(folder);
  throw Error{Fault::data,
              folder + ": already resumed, by " + (by.empty() ? "another print" : by) + "; resume that one instead"};
}

/// Where settings that decide the dose or its place are not the same.
std::vector<std::string> differences(const model::Printer& then, const model::Printer& now) {
  std::vector<std::string> changed = io::changed_settings(then, now);
  std::erase_if(changed, [](const std::string& text) {
    const std::string key = text.substr(0, text.find(' '));
    const auto of = [&](const char* section) { return key.starts_with(section); };
    const bool counts = of("projector.") || of("vial.") || of("bath.") || of("resin.") || key == "stage.speed_deg_s" ||
                        key == "stage.direction";
    return !counts || key == "projector.relay" || key == "resin.name";
  });
  return changed;
}

// In the events of the print that is resumed; one that ended has their hash.
void tell(const std::string& folder, const std::string& event, const Json& facts) {
  if (fs::exists(folder + "/SHA256SUMS")) return;
  device::EventLog(folder + "/events.jsonl", "vam-print")(event, facts);
}

// The last image that was shown, and how far the stage turns from one to the next.
struct LastImage {
  std::optional<double> at_deg;
  double step_deg = 0;
  bool is_chained = true;
};

LastImage last_image(const std::string& folder, const std::string& sinogram) {
  LastImage image;
  if (!has_regular_file(folder + "/flips.jsonl")) return image;
  io::FlipLog log(folder);
  log.read();
  image.is_chained = log.is_chained();
  if (log.sinograms().size() > 1) {
    throw Error{Fault::data, folder + ": showed new projections, so that the rest is not that of " + sinogram +
                                 "; compute it (vam-dose --shown, vam-optimize --delivered) and print that"};
  }
  for (const io::LoggedFlip& flip : log.flips()) {
    if (flip.frame < 0) continue;
    if (image.at_deg) image.step_deg = flip.angle_deg - *image.at_deg;
    image.at_deg = flip.angle_deg;
  }
  return image;
}

}  // namespace

void take_over(Run& run) {
  const std::string folder = run.options.resume;
  io::require_run(folder);
  require_over(folder);  // what it has shown is known from then on
  const io::RunEvents events = io::read_events(folder);
  if (events.outcome == "complete, in open loop")
    throw Error{Fault::data, folder + ": is complete; it ended in open loop, with the turns of its plan"};
  if (events.turns < 1 || events.turns != std::floor(events.turns)) {
    throw Error{Fault::no_input, folder + ": not the run folder of a print that was armed; see its events.jsonl"};
  }
  const LastImage image = last_image(folder, run.options.sinogram);
  if (events.sinogram_sha256 != run.sinogram_sha256)
    throw Error{Fault::data, run.options.sinogram + ": not the sinogram of " + folder};
  require_not_resumed(folder);
  // The middle of the last image, and half of what the stage turned from one image to the next.
  if (image.at_deg && *image.at_deg + image.step_deg >= turn_deg * events.turns) {
    throw Error{Fault::data,
                folder + ": complete, all " + format_number(events.turns) + " turns; nothing is left to print"};
  }
  if (!image.is_chained) {
    throw Error{Fault::data, folder +
                                 "/flips.jsonl: has no chain, by which lost lines would be found, whose light "
                                 "would be given twice; compute the rest (vam-dose --shown, vam-optimize "
                                 "--delivered) and print that"};
  }
  const double from_deg = image.at_deg ? *image.at_deg + image.step_deg / 2 : events.from_deg;
  const double given = std::floor(from_deg / turn_deg);
  constexpr double digits = 1e4;
  run.resumed_utc = events.armed_utc;
  run.turns = static_cast<int>(events.turns - given);
  run.from_deg = std::round((from_deg - turn_deg * given) * digits) / digits;
  if (!run.options.printer.file.empty()) return;
  // The settings that it was armed with, calibration included; records of today have no part in them.
  run.printer_words.insert(run.printer_words.begin(), {"--printer", folder + "/printer.toml"});
  run.frozen = folder;
  run.scans.clear();
}

void require_same_settings(const Run& run) {
  const std::string& folder = run.options.resume;
  if (folder.empty()) return;
  const auto then = io::frozen(io::load_printer(folder + "/printer.toml", {"calibration.folder="}));
  for (const std::string& device : {then.stage.device, run.printer.stage.device}) {
    if (!device.starts_with("grbl:")) continue;
    if (device.find("?home=here") == std::string::npos && device.find("&home=here") == std::string::npos) continue;
    throw Error{Fault::data,
                "--resume: the stage has home=here, whose zero ended with the print; only a stage that finds its zero "
                "can resume"};
  }
  const auto different = differences(then, run.printer);
  if (different.empty()) return;
  const std::string text = folder + ": printed with other settings: " + join(different, "; ");
  if (!run.options.accept_printer)
    throw Error{Fault::data, text + "; omit --printer and --set, or give --accept-printer"};
  say(text + "; accepted");
}

void require_same_device(const Run& run, const std::string& name) {
  const std::string then = text_of(run.frozen + "/" + name + ".json");
  if (then == text_of(run.file(name + ".json"))) return;
  say(run.frozen + ": printed with another " + name + " (" + name + ".json differs); connect that one");
  throw Ended{static_cast<int>(Fault::data)};
}

void Claim::take(const Run& run) {
  const std::string& folder = run.options.resume;
  if (folder.empty()) return;
  const std::string mark = folder + "/resumed.json";
  const std::string by = fs::canonical(run.folder).string();
  const int made = open(mark.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (made < 0 && errno == EEXIST) require_not_resumed(folder);
  const std::string text = Json{{"utc", utc_text(utc_seconds())}, {"resumed_by", by}}.dump() + "\n";
  const bool written = made >= 0 && write(made, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (made >= 0) close(made);
  const auto give_up = [&](const std::string& file) {
    unlink(mark.c_str());
    throw Error{Fault::no_output, file + ": cannot be written; it is required so that the rest is not printed twice"};
  };
  if (!written) give_up(mark);
  mark_ = mark;  // from here on every way out takes it back
  device::bring_to_disk({run.file("events.jsonl"), run.folder});
  try {
    tell(folder, "resumed", {{"by", by}});
  } catch (const std::exception&) {
    mark_.clear();
    give_up(folder + "/events.jsonl");
  }
  device::bring_to_disk({mark, folder + "/events.jsonl", folder});
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {  // what one that was killed could not remove
    if (entry.is_fifo(ignored) || entry.path().filename() == ".reserve") fs::remove(entry.path(), ignored);
  }
}

void Claim::release(const Run& run, bool lit) {
  if (mark_.empty() || lit) return;
  std::error_code ignored;
  fs::remove(run.file(".reserve"), ignored);
  try {
    tell(run.options.resume, "released", Json::object());
    fs::remove(mark_, ignored);
  } catch (const std::exception&) {
    say(run.options.resume +
        "/events.jsonl: cannot be written; the print counts as resumed; free space on the disk, and remove " + mark_ +
        " and the last line with \"resumed\"");
  }
}

}  // namespace vam::print_tool
