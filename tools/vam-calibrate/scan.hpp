// SPDX-License-Identifier: GPL-3.0-or-later
// The calibration scans: captured frames in, a calibration record out.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "base/stats/measured.hpp"
#include "base/text/json.hpp"
#include "cli/common.hpp"
#include "io/settings/calibration_record.hpp"
#include "metrology/calibrate/axis.hpp"
#include "model/mesh.hpp"
#include "model/printer.hpp"
#include "optics/patterns.hpp"

namespace vam::calibrate_tool {

struct ScanOptions {
  std::string command;
  std::string from;     // the frames
  std::string reverse;  // lag: those of the turn the other way
  std::string angles;   // lag: the samples of the stage during both turns
  std::string flips;    // log of vam-project from the time of the capture
  std::string dark;
  bool accept = false;
  int heights = 5;
  int pitch_px = optics::sweep_line_px, width_px = optics::sweep_line_px,
      steps = optics::PatternPlan{}.steps;  // of the pattern
  std::optional<double> first_mm, step_mm;  // beam: planes
  double pixel_mm = 0;                      // and the sensor's pitch
  bool side = false;                        // beam: frames of a camera beside the vial
  std::optional<double> step_deg;           // axis: frames without recorded angles
  std::string devices;                      // identities of the devices in use
  std::vector<std::string> needed;          // check: lists of scans
  std::string design;                       // registration
  std::optional<double> isovalue;           // of the print's surface in its volume
  cli::PrinterOptions printer;
};

class Finding;
using Scan = Finding (*)(const ScanOptions&, const model::Printer&);

/// The record in force of a scan; nothing where it must not be used.
[[nodiscard]] std::optional<io::CalibrationRecord> usable_record(const model::Calibration& calibration,
                                                                 const std::string& scan);

/// Keeps what the scan finds as its record. Throws as the scan does, Fault::judged when its result must not be used.
void run_scan(const cli::App& app, const std::string& command, Scan scan, ScanOptions& options);

// ---- frames.cpp: which pattern frame each camera frame shows

struct ScanFrame {
  Image image;
  double time_s = 0;        // middle of the exposure
  double time_sigma_s = 0;  // shared by the frames of a capture; 0: not known
  double angle_deg = 0;     // NaN: not known
  double pixel_mm = 0;      // at the axis, as the frames say, else the printer
  int shown = 0;            // pattern frame during the whole exposure: by the flips, else the frame's own number
};

/// What a scan needs of its frames: any angle, one each, or also those during which the pattern changed.
enum class FrameKind { steady, turned, changing };

/// Calls `take` for every frame, in order; with flips only for those during which one pattern frame was on, unless
/// changing ones are wanted.
/// Throws Error: no_input, data (also a frame that is over-exposed), usage (flips, but frames without times).
void each_frame(const ScanOptions& options, const model::Printer& printer, FrameKind wanted,
                const std::function<void(const ScanFrame&)>& take);

/// A pattern frame and when it came on.
struct DisplayHistory {
  double t_s = 0;
  int frame = -1;  // -1: black
};
/// The changes of pattern frame in a log of vam-project. Throws Error: no_input, data.
[[nodiscard]] std::vector<DisplayHistory> read_flips(const std::string& path);

/// Frames of something that turns with the stage.
struct BeadTurn {
  metrology::TurnScan scan;
  std::vector<double> time_s;  // of each frame
  double time_sigma_s = 0;     // that they share, the largest stated
  double pixel_mm = 0;
};
/// Where an image shows it, in each of so many bands of rows.
using ColumnsOfBands = std::vector<double> (*)(const Image& frame, int bands);
/// Throws Error: no_input, data, usage (frames without angles).
[[nodiscard]] BeadTurn read_turn(const ScanOptions& options, const model::Printer& printer, ColumnsOfBands columns_of);

/// The surface of a print, without crumbs where it is a volume. Throws Error: usage (a volume without an isovalue),
/// no_input, data.
[[nodiscard]] model::TriangleSoup print_surface(const std::string& path, std::optional<double> isovalue);

// ---- edges.cpp and its neighbours: one measurement each
[[nodiscard]] Finding scan_edges(const ScanOptions& options, const model::Printer& printer);
[[nodiscard]] Finding scan_response(const ScanOptions& options, const model::Printer& printer);
[[nodiscard]] Finding scan_axis(const ScanOptions& options, const model::Printer& printer);
[[nodiscard]] Finding scan_lag(const ScanOptions& options, const model::Printer& printer);
[[nodiscard]] Finding scan_latency(const ScanOptions& options, const model::Printer& printer);
[[nodiscard]] Finding scan_beam(const ScanOptions& options, const model::Printer& printer);
[[nodiscard]] Finding scan_registration(const ScanOptions& options, const model::Printer& printer);
[[nodiscard]] Finding scan_flat(const ScanOptions& options, const model::Printer& printer);
inline constexpr double wanted_axis_sigma_px = 0.1;   // of an axis, the vial's or the camera's
inline constexpr double wanted_delay_sigma_ms = 0.5;  // of a delay, the camera's or the projector's

// ---- record.cpp: from result to record

/// The result of a scan.
class Finding {
 public:
  void value(const std::string& name, const stats::Measured& measured, const std::string& unit,
             const std::string& method);
  /// Fails where a standard deviation is above the most that is allowed, both in `unit`.
  void require_sigma(const std::string& of, double sigma, double most, const std::string& unit,
                     const std::string& remedy = {});
  /// The result is used with a warning.
  void warn_because(const std::string& reason);
  /// The result must not be used.
  void fail_because(const std::string& reason);

  Json facts = Json::object();  // beside values and status
  /// Contents of a file that belongs to the record: its name in "files", its ending, and what writes it.
  struct Product {
    std::string name;
    std::string ending;
    std::function<void(const std::string& path)> write;
  };
  std::vector<Product> products;

 private:
  friend void keep(const cli::App&, const ScanOptions&, const model::Printer&, Finding);
  Json values_ = Json::object();
  std::vector<std::string> warnings_, failures_;
};

/// A value with its unit, sigma, n and method, as records have it.
[[nodiscard]] Json measured_json(const stats::Measured& measured, const std::string& unit, const std::string& method);

/// Writes the record of options.command with the hashes of the frames into calibration.folder; without a folder to
/// stdout, products left out. Throws Fault::judged when it failed, also where the printer cannot have its values.
void keep(const cli::App& app, const ScanOptions& options, const model::Printer& printer, Finding finding);

/// Prints the current records and their validity as JSON. Throws Fault::data when a needed one is missing, and when one
/// is stale, foreign or beyond what this printer can have.
void check_records(const ScanOptions& options);

// ---- commands of their own, which run what throws Error: usage, no_input, data, no_output

/// The scans one after the other, with their frames; sets the exit status where a tool has said why it failed.
void add_all(cli::App& app, int& status);

/// The gelation threshold as a resin record, from a printed standard.
void add_resin(cli::App& app);

/// Scattering against dose as a resin record, from a staircase of doses.
void add_working_curve(cli::App& app);

/// The dose at the surface of a print; judged where the surface does not follow the dose.
void add_critical_dose(cli::App& app);

/// Light of the projector by grey level: the table of projector.response.
void add_photodiode(cli::App& app);

/// Cured thickness by exposure: the working curve of stereolithography [CURE19 fig 5a].
void add_cure_depth(cli::App& app);

}  // namespace vam::calibrate_tool
