// SPDX-License-Identifier: GPL-3.0-or-later
// Calibration records: what a scan measured, one immutable JSON file a scan, and a link to the one in force.
//   cal-INSTRUMENT-SCAN-UTC.json   never written twice; made read-only
//   current-SCAN.json              a link to one of them, changed in one step
// A record holds schema, scan, utc, valid_until, instrument, vial, tool, status (pass, warn, fail) with reasons, values
// {name: {value, unit, sigma, n, method}}, and what else the scan has to say (settings, devices, files, sha256).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "model/printer.hpp"

namespace vam::io {

/// edges, response, flat, beam, axis, latency, lag, registration: the order in which their records are taken over.
[[nodiscard]] const std::vector<std::string>& calibration_scans();

/// The path of a new file that belongs to the record, "FOLDER/cal-INSTRUMENT-SCAN-UTC" + ending. Makes the folder.
/// Throws Fault::usage when calibration.folder is empty, Fault::no_output.
[[nodiscard]] std::string record_path(const model::Calibration& calibration, const std::string& scan, double utc_s,
                                      const std::string& ending);

/// Adds the head (schema ... vial) to `facts`, writes the record and, unless its status is "fail", makes it the current
/// one. Returns its path. Throws Error: no_output (one of this time exists), io.
std::string write_record(const model::Calibration& calibration, const std::string& scan, const Json& facts,
                         double utc_s);

struct CalibrationRecord {
  std::string path;
  std::shared_ptr<const Json> json;  // never null
  [[nodiscard]] double value(const std::string& name) const;
  [[nodiscard]] double sigma(const std::string& name) const;
};

/// A record, unjudged. Throws Error: no_input, data (another file, or changed after it was written).
[[nodiscard]] CalibrationRecord read_record(const std::string& path);

/// The current record of a scan, unjudged; nothing when there is none. Throws Fault::data for a damaged one, and for
/// one that its seal is not of, Fault::no_input where its link leads nowhere.
[[nodiscard]] std::optional<CalibrationRecord> current_record(const model::Calibration& calibration,
                                                              const std::string& scan);

/// Why the record must not be used now by this instrument: "is 31 h old, 7 h past its validity; run vam-calibrate";
/// empty when it may be.
[[nodiscard]] std::string objection(const CalibrationRecord& record, const model::Calibration& calibration,
                                    double utc_s);

/// Takes over what one record says. Throws Fault::data where a value is missing or beyond the ranges of the printer
/// file, or a table has changed.
void apply_record(model::Printer& printer, const CalibrationRecord& record);

/// Takes over what the current records say: projector.axis_column and vial.radius_mm (edges), projector.response
/// (response), projector.latency_ms (latency), projector.half_angle_deg and focus_mm (beam), camera.axis_column and
/// tilt_deg (axis), camera.flat (flat), camera.lag_ms (lag), camera.azimuth_deg, axis_row and pixel_mm (registration).
/// Nothing without calibration.folder. Throws Fault::data with the first objection.
void apply_records(model::Printer& printer, const model::Calibration& calibration, double utc_s);

}  // namespace vam::io
