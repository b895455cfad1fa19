// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/pose_file.hpp"

#include <cmath>
#include <stdexcept>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "io/settings/calibration_record.hpp"
#include "io/settings/csv_table.hpp"

namespace vam::io {

model::Poses read_poses(const std::string& path) {
  const CsvTable table = read_csv(path, {"angle_deg", "dx_mm", "dy_mm", "dz_mm", "moves"});
  model::Poses poses;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    try {
      poses.push_back(model::pose_of(table.rows[row]));
    } catch (const std::runtime_error& problem) {
      throw Error{Fault::data, table.source + ":" + std::to_string(table.lines[row]) + ": " + problem.what()};
    }
  }
  return poses;
}

void require_angles(const std::string& path, const model::Poses& poses, int frames, double start_deg, double step_deg) {
  if (frames > 0 && poses.size() != static_cast<std::size_t>(frames)) {
    throw Error{Fault::data, path + ": has " + std::to_string(poses.size()) + " poses, but the stack has " +
                                 std::to_string(frames) + " frames; one pose per frame is required"};
  }
  if (const std::string why = model::objection(poses, start_deg, step_deg); !why.empty()) {
    throw Error{Fault::data, path + ": " + why + "; the step is 360 degrees divided by the number of stage angles"};
  }
}

WobbleRecord read_wobble(const std::string& path, const model::Printer& printer, int direction) {
  const CalibrationRecord record = read_record(path);
  const std::string scan = (*record.json)["scan"];
  const auto refuse = [&](const std::string& why) { return Error{Fault::data, path + ": " + why}; };
  if (scan != "edges" && scan != "axis") throw refuse("is a record of " + scan + ", not of edges or axis");
  if (record.json->value("status", "") == "fail") throw refuse("is the record of a failed scan; run vam-calibrate");
  if (const std::string why = objection(record, printer.calibration, utc_seconds()); !why.empty()) {
    warn(path + ": " + why);
  }
  WobbleRecord wobble;
  try {
    wobble = {record.value("wobble_mm"), record.value("wobble_phase")};
  } catch (const Error&) {
    throw refuse("lacks wobble_mm and wobble_phase; give a record of axis, or of edges at several stage angles");
  }
  if (!(wobble.radius_mm >= 0)) throw refuse("has a wobble of " + format_number(wobble.radius_mm) + " mm");
  // At the phase the vial is furthest along the columns, which lie along +x turned by the azimuth.
  const double azimuth_deg = scan == "axis" ? printer.camera.azimuth_deg : 0;
  wobble.lab_angle_deg = azimuth_deg + direction * wobble.lab_angle_deg;
  return wobble;
}

std::optional<double> wobble_in_force_mm(const model::Calibration& calibration) {
  const auto record = current_record(calibration, "edges");
  if (!record || !record->json->at("values").contains("wobble_mm")) return std::nullopt;
  const Json& wobble = record->json->at("values").at("wobble_mm");
  const double radius_mm = number_at(wobble, "value");
  return radius_mm > 3 * number_at(wobble, "sigma") ? std::optional(radius_mm) : std::nullopt;
}

}  // namespace vam::io
