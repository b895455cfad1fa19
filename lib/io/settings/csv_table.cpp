// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/stream/input_name.hpp"
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

}  // namespace vam::io
