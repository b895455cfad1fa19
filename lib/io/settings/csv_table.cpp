// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "io/settings/calibration_record.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr std::uint64_t size_limit = std::uint64_t{64} << 20;
constexpr std::string_view quotes = " \t\r\"";

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells = split(line, ',');
  for (std::string& cell : cells) cell = trimmed(cell, quotes);
  return cells;
}

// Where each requested column stands in the header.
std::vector<std::size_t> places_of(const std::vector<std::string>& header, const std::vector<std::string>& columns,
                                   const std::string& place) {
  std::vector<std::size_t> places;
  for (const std::string& column : columns) {
    const auto found = std::find(header.begin(), header.end(), column);
    if (found == header.end()) {
      throw Error{Fault::data, place + ": no column '" + column + "'; the header must name " + join(columns, ",") +
                                   did_you_mean(column, header)};
    }
    places.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  return places;
}

}  // namespace

double CsvTable::number(std::size_t row, std::size_t column) const {
  const std::string& cell = rows[row][column];
  const auto value = parse_number(cell);
  if (value && std::isfinite(*value)) return *value;
  throw Error{Fault::data, source + ":" + std::to_string(lines[row]) + ": " + columns[column] + " " + excerpt(cell) +
                               " is not a number"};
}

std::vector<double> CsvTable::column(std::size_t column) const {
  std::vector<double> values;
  for (std::size_t row = 0; row < rows.size(); ++row) values.push_back(number(row, column));
  return values;
}

CsvTable read_csv(const std::string& path, const std::vector<std::string>& columns) {
  CsvTable table{input_name(path), columns, {}, {}};
  std::vector<std::size_t> places;
  int number = 0;
  for (const std::string& raw : split(read_all(path, Content::text, size_limit), '\n')) {
    ++number;
    const std::string line = trimmed(raw, quotes);
    if (line.empty() || line[0] == '#') continue;
    const std::string place = table.source + ":" + std::to_string(number);
    std::vector<std::string> cells = cells_of(raw);
    if (places.empty()) {
      const bool numbers = std::all_of(cells.begin(), cells.end(),
                                       [](const std::string& cell) { return parse_number(cell).has_value(); });
      for (std::size_t i = 0; numbers && i < columns.size(); ++i) places.push_back(i);
      if (numbers && columns.empty()) throw Error{Fault::data, place + ": no header; the first line names the columns"};
      if (!numbers) {
        if (columns.empty()) table.columns = cells;
        places = places_of(cells, table.columns, place);
        continue;
      }
    }
    std::vector<std::string>& row = table.rows.emplace_back();
    for (const std::size_t at : places) {
      if (at >= cells.size()) {
        throw Error{Fault::data,
                    place + ": " + std::to_string(cells.size()) + " cells; give " + join(table.columns, ",")};
      }
      row.push_back(cells[at]);
    }
    table.lines.push_back(number);
  }
  if (table.rows.empty()) {
    throw Error{Fault::data, table.source + ": no rows" + (columns.empty() ? "" : "; give " + join(columns, ","))};
  }
  return table;
}

namespace {

std::optional<double> cell(const std::string& text) {
  const auto number = parse_number(trimmed(text));
  return number && std::isfinite(*number) ? number : std::nullopt;
}

// The columns are known by it.
void require_header(const std::vector<std::string>& cells, const std::string& line, const std::string& place) {
  constexpr std::string_view around = " \t\"";
  if (cells.size() == 2 && trimmed(cells[0], around) == "grey" && trimmed(cells[1], around) == "intensity") return;
  throw Error{Fault::data, place + ": " + excerpt(line) + " is not the header 'grey,intensity' of a response"};
}

void append(model::ResponseTable& table, double grey, double intensity, const std::string& place) {
  if (table.grey.empty() && grey != 0) {
    throw Error{Fault::data, place + ": the first grey is " + format_number(grey) + "; the table must begin at grey 0"};
  }
  if (!table.grey.empty() && grey <= table.grey.back()) {
    throw Error{Fault::data, place + ": grey " + format_number(grey) + " does not rise above " +
                                 format_number(table.grey.back()) + "; sort the table by grey"};
  }
  if (intensity < 0 || (!table.intensity.empty() && intensity < table.intensity.back())) {
    throw Error{Fault::data, place + ": intensity " + format_number(intensity) + " at grey " + format_number(grey) +
                                 " is below " + format_number(table.intensity.empty() ? 0 : table.intensity.back()) +
                                 "; a response must be monotonic; measure it again or smooth it"};
  }
  constexpr double most_intensity = 1e9;  // in any unit
  if (intensity > most_intensity) {
    throw Error{Fault::data, place + ": intensity " + format_number(intensity) +
                                 " is more than 1e9, which is none in any unit; measure it again"};
  }
  table.grey.push_back(grey);
  table.intensity.push_back(intensity);
}

// Greys of another scale, as of a table from 0 to 1, are warned of as well: whose light is at which is not known.
void require_levels(const model::ResponseTable& table, int bits) {
  const double last = table.grey.back();
  const double full = std::ldexp(1.0, bits) - 1;
  const std::string beside = "; projector.bits " + std::to_string(bits) + " end at " + format_number(full, 9);
  if (last > full) {
    throw Error{Fault::data, table.source + ": the greys end at " + format_number(last, 9) + beside +
                                 "; measure the response with these bits"};
  }
  if (last < full) {
    warn(table.source + ": the greys end at " + format_number(last, 9) + beside +
         ": its last line is taken for full grey; the table may be cut");
  }
}

}  // namespace

model::ResponseTable read_response(const std::string& file, int bits) {
  constexpr std::uint64_t most_bytes = std::uint64_t{16} << 20;
  model::ResponseTable table;
  table.source = file;
  bool begun = false;
  int number = 0;
  for (const std::string& raw : split(read_all(file, Content::text, most_bytes), '\n')) {
    ++number;
    const std::string line = trimmed(raw);
    if (line.empty() || line[0] == '#') continue;
    const std::string place = file + ":" + std::to_string(number);
    const auto cells = split(line, ',');
    if (!begun) {
      require_header(cells, line, place);
      begun = true;
      continue;
    }
    const auto grey = cell(cells[0]);
    const auto intensity = cells.size() == 2 ? cell(cells[1]) : std::nullopt;
    if (!grey || !intensity) {
      throw Error{Fault::data, place + ": " + excerpt(line) + " is not two numbers 'grey,intensity'"};
    }
    append(table, *grey, *intensity, place);
  }
  if (table.grey.size() < 2 || table.intensity.back() <= 0) {
    throw Error{Fault::data,
                file + ": a response needs at least two lines 'grey,intensity' and a positive intensity at full grey"};
  }
  require_levels(table, bits);
  return table;
}

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
