// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-dose/shown.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/settings/flip_log.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/printer_match.hpp"
#include "io/settings/run_folder.hpp"
#include "io/stream/stream.hpp"

namespace vam::dose_tool {

namespace {

namespace fs = std::filesystem;

// The log of a run, by whatever name; its light counts once.
fs::path log_of(const std::string& run) {
  return fs::weakly_canonical(fs::is_directory(run) ? fs::path(run) / "flips.jsonl" : fs::path(run));
}

void require_distinct_runs(const std::vector<std::string>& runs) {
  std::set<fs::path> logs;
  for (const std::string& run : runs) {
    if (logs.insert(log_of(run)).second) continue;
    throw Error{Fault::usage,
                "--shown: " + run + " is given twice, but its light was delivered once; give each run once"};
  }
}

std::string folder_of(const std::string& run) {
  return fs::is_directory(run) ? run : log_of(run).parent_path().string();
}

// A run folder, or the log of one.
bool is_of_run(const std::string& run) {
  const fs::path folder = folder_of(run);
  return fs::is_directory(run) || has_regular_file((folder / "events.jsonl").string()) ||
         (io::has_run_sums(folder.string()) && io::read_run_sums(folder.string()).contains("events.jsonl"));
}

// What was edited since the print ended states another exposure than was delivered; a log alone may lie anywhere.
void require_unchanged(const std::string& run) {
  if (is_of_run(run)) io::require_run_logs(folder_of(run));
}

// A resumption shows the rest only: without the run that it resumes the dose is too low.
void warn_of_rest(const std::vector<std::string>& runs) {
  for (const std::string& run : runs) {
    const std::string first = is_of_run(run) ? io::read_events(folder_of(run)).resumes : "";
    const auto is_first = [&](const std::string& one) { return io::resumes(folder_of(run), folder_of(one)); };
    if (first.empty() || std::any_of(runs.begin(), runs.end(), is_first)) continue;
    warn(run + ": resumes " + first + ", whose light is not counted; give it, too: --shown " + first);
  }
}

// The settings that a run froze; empty: it is a log alone, or they are gone.
std::string settings_of(const std::string& run) {
  const std::string file = (fs::path(folder_of(run)) / "printer.toml").string();
  return is_of_run(run) && fs::is_regular_file(file) ? file : "";
}

std::string require_settings(const std::string& run) {
  std::string file = settings_of(run);
  if (file.empty() && is_of_run(run)) {
    throw Error{Fault::no_input, (fs::path(folder_of(run)) / "printer.toml").string() +
                                     ": is gone; restore it, or give the settings of the print by --printer"};
  }
  return file;
}

// The full intensity of a run over that of the printer in use, in whose turns all is counted: those of the first run; a
// resumption may have had another intensity and speed. The light of all must go the same way.
double intensity_of(const std::string& run, bool first, const model::Printer& now) {
  const std::string file = settings_of(run);
  if (file.empty()) return 1;
  const model::Printer then = io::load_printer(file, {}, io::Records::ignore);
  const auto differences = io::differences(then, now, first ? io::Matter::dose : io::Matter::light);
  if (differences.empty()) return then.projector.max_intensity_mw_cm2 / now.projector.max_intensity_mw_cm2;
  throw Error{Fault::data, run + ": was printed with other settings: " + join(differences, "; ") +
                               "; omit --printer and --set, or give --printer " + file};
}

}  // namespace

cli::PrinterOptions printer_of(const Options& options) {
  cli::PrinterOptions printer = options.printer;
  if (printer.file.empty() && !options.shown.empty()) printer.file = require_settings(options.shown.front());
  return printer;
}

void take_sinogram(const cli::App& app, Options& options) {
  struct stat about = {};
  const bool piped = fstat(STDIN_FILENO, &about) == 0 && !S_ISCHR(about.st_mode);  // a terminal, or /dev/null
  if (options.shown.empty() || app.given("SINOGRAM") || piped) return;
  const std::string& run = options.shown.front();
  const std::string file = (fs::path(run) / "sinogram.exr").string();
  if (!fs::is_directory(run) || !has_regular_file(file))
    throw Error{Fault::usage, "SINOGRAM: is missing, and " + run + " has no sinogram.exr; give the one that was shown"};
  io::FlipLog log(run);
  log.read();
  std::set<std::string> hashes;
  for (const io::ShownSinogram& one : log.sinograms()) hashes.insert(one.sha256);
  if (hashes.size() > 1) {
    throw Error{Fault::usage, "SINOGRAM: is missing, and " + run + " showed " + std::to_string(hashes.size()) +
                                  " one after the other; give all of them"};
  }
  options.inputs = {file};
}

void take_full_scale(Options& options) {
  if (options.shown.empty()) return;
  for (const std::string& one : options.shown) require_unchanged(one);
  warn_of_rest(options.shown);
  const std::string& run = options.shown.front();
  const std::string& sinogram = options.inputs.front();
  const double stated = io::read_showing(run, sinogram).full_scale;
  if (!(stated > 0)) return;
  constexpr double same = 1e-6;
  if (options.full_scale && std::abs(*options.full_scale / stated - 1) > same) {
    throw Error{Fault::usage, "--full-scale: " + run + " showed " + sinogram + " at a full scale of " +
                                  format_number(stated) + ", not " + format_number(*options.full_scale) + "; omit it"};
  }
  options.full_scale = stated;
}

double shown_full_scale(const Options& options, const std::string& sinogram) {
  const double stated = io::read_showing(options.shown.front(), sinogram).full_scale;
  if (stated > 0) return stated;
  throw Error{Fault::data, options.shown.front() + ": does not state the full scale of " + sinogram +
                               "; its light adds up with no other"};
}

std::vector<double> shown_turns(const Options& options, const std::string& sinogram,
                                const std::optional<double>& full_scale, const model::StackInfo& info,
                                const model::Printer& printer) {
  if (options.shown.empty()) return {};
  require_distinct_runs(options.shown);
  const io::StageRows rows{info.height, info.angle_start_deg, info.angle_step_deg};
  if (std::abs(std::abs(rows.step_deg) * rows.count - 360) > 0.01 * std::abs(rows.step_deg)) {
    throw Error{Fault::data, sinogram + ": covers " + format_number(std::abs(rows.step_deg) * rows.count) +
                                 " degrees of stage angles; --shown requires one turn"};
  }
  std::vector<double> turns(info.height);
  for (const std::string& run : options.shown) {
    const io::DisplayHistory showing = io::read_showing(run, sinogram, options.before_s);
    double intensity = intensity_of(run, run == options.shown.front(), printer);
    if (full_scale && showing.full_scale > 0) intensity *= *full_scale / showing.full_scale;
    const auto of_run = io::turns_shown(showing.images, rows, printer.stage.speed_deg_s);
    std::transform(turns.begin(), turns.end(), of_run.begin(), turns.begin(),
                   [&](double sum, double one) { return sum + intensity * one; });
  }
  return turns;
}

std::vector<double> shares_of(double turns, int rows) {
  const double whole = std::floor(turns);
  std::vector<double> shares;
  for (int row = 0; row < rows && turns != whole; ++row)
    shares.push_back((whole + std::clamp((turns - whole) * rows - row, 0.0, 1.0)) / turns);
  return shares;
}

void require_all_sinograms(const Options& options) {
  std::set<std::string> given;  // "" from a pipe, which is the only one of its print [require_sinogram_of]
  for (const std::string& input : options.inputs) given.insert(input == "-" ? "" : io::sha256_of(input));
  for (const std::string& run : options.shown) {
    io::FlipLog log(run);
    log.read();
    if (options.before_s) log.truncate_at(*options.before_s);
    for (const io::ShownSinogram& one : log.sinograms()) {
      if (one.sha256.empty() || given.contains("") || given.contains(one.sha256)) continue;
      const std::size_t images = log.shown_of(one.sha256).size();
      if (images == 0) continue;
      throw Error{Fault::usage, "--shown: " + run + " showed " + std::to_string(images) + " images of " +
                                    (one.name.empty() ? "another sinogram" : excerpt(one.name)) + " (SHA-256 " +
                                    one.sha256.substr(0, 8) + "...), which is not given; give all that were shown"};
    }
  }
}

void weigh(const std::vector<double>& turns, std::span<Image> sinograms) {
  if (turns.empty()) return;
  for (Image& image : sinograms) {
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) image(column, row) *= static_cast<float>(turns[row]);
    }
  }
}

}  // namespace vam::dose_tool
