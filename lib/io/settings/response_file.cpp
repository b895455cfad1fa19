// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/response_file.hpp"

#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

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

}  // namespace vam::io
