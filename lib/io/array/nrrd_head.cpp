// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/array/private/nrrd_head.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/text/format_version.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"

namespace vam::io::arrays {

namespace {

using Fields = std::map<std::string, std::string>;

constexpr const char* remedy = "; write it with: unu save -f nrrd -e raw";

/// "field: value", and neither comments nor "key:=value", up to an empty line.
Fields take_fields(Bytes& bytes) {
  constexpr int most = 4096;
  Fields fields;
  for (int count = 0; count < most; ++count) {
    const std::string line = bytes.line();
    if (line.empty()) return fields;
    if (line.starts_with(version_name + std::string(":="))) {
      const std::string why = FormatKind("NRRD").objection(line.substr(line.find('=') + 1));
      if (!why.empty()) bytes.fail(why);
    }
    const std::size_t colon = line.find(": ");
    if (line.starts_with('#') || line.find(":=") != std::string::npos) continue;
    if (colon == std::string::npos) bytes.fail("its header is damaged: " + excerpt(line) + " is no field");
    std::string value = line.substr(colon + 2);
    value.erase(0, std::min(value.find_first_not_of(' '), value.size()));
    value.erase(value.find_last_not_of(' ') + 1);
    const std::string name = line.substr(0, colon);
    if (name == "data file" || name == "datafile")  // such a header may end without an empty line
      bytes.fail("has its values in another file (a detached header)" + std::string(remedy));
    if (!fields.try_emplace(name, value).second) {
      bytes.fail("its header states " + excerpt(name) + " twice, of which only one would count" + remedy);
    }
  }
  bytes.fail("its header does not end");
}

const std::string& field(const Bytes& bytes, const Fields& fields, const std::string& name) {
  const auto found = fields.find(name);
  if (found == fields.end()) bytes.fail("its header has no '" + name + "'");
  return found->second;
}

struct TypeName {
  const char* name;
  char kind;
  int bytes;
};

constexpr TypeName types[] = {
    {"signed char", 'i', 1},
    {"int8", 'i', 1},
    {"int8_t", 'i', 1},
    {"uchar", 'u', 1},
    {"unsigned char", 'u', 1},
    {"uint8", 'u', 1},
    {"uint8_t", 'u', 1},
    {"short", 'i', 2},
    {"short int", 'i', 2},
    {"signed short", 'i', 2},
    {"signed short int", 'i', 2},
    {"int16", 'i', 2},
    {"int16_t", 'i', 2},
    {"ushort", 'u', 2},
    {"unsigned short", 'u', 2},
    {"unsigned short int", 'u', 2},
    {"uint16", 'u', 2},
    {"uint16_t", 'u', 2},
    {"int", 'i', 4},
    {"signed int", 'i', 4},
    {"int32", 'i', 4},
    {"int32_t", 'i', 4},
    {"uint", 'u', 4},
    {"unsigned int", 'u', 4},
    {"uint32", 'u', 4},
    {"uint32_t", 'u', 4},
    {"longlong", 'i', 8},
    {"long long", 'i', 8},
    {"long long int", 'i', 8},
    {"signed long long", 'i', 8},
    {"signed long long int", 'i', 8},
    {"int64", 'i', 8},
    {"int64_t", 'i', 8},
    {"ulonglong", 'u', 8},
    {"unsigned long long", 'u', 8},
    {"unsigned long long int", 'u', 8},
    {"uint64", 'u', 8},
    {"uint64_t", 'u', 8},
    {"float", 'f', 4},
    {"double", 'f', 8},
};

void set_type(const Bytes& bytes, const std::string& name, Head& head) {
  const auto* type =
      std::find_if(std::begin(types), std::end(types), [&](const TypeName& t) { return name == t.name; });
  if (type == std::end(types)) bytes.fail("has values of type " + excerpt(name) + ", which are no numbers");
  head.kind = type->kind;
  head.bytes = type->bytes;
}

/// The fastest first in the file.
std::vector<std::uint64_t> shape_of(const Bytes& bytes, const std::string& text) {
  std::vector<std::uint64_t> shape;
  const char* at = text.data();
  const char* end = at + text.size();
  while (at < end && shape.size() < 33) {
    std::uint64_t size = 0;
    const auto [next, problem] = std::from_chars(at, end, size);
    if (problem != std::errc{}) bytes.fail("its header is damaged: sizes " + excerpt(text));
    shape.push_back(size);
    at = std::find_if(next, end, [](char c) { return c != ' '; });
  }
  std::reverse(shape.begin(), shape.end());
  return shape;
}

void require_plain(const Bytes& bytes, const Fields& fields) {
  for (const char* name : {"line skip", "lineskip", "byte skip", "byteskip"}) {
    const auto found = fields.find(name);
    if (found != fields.end() && found->second != "0") {
      bytes.fail("skips bytes before its values (" + std::string(name) + ")" + remedy);
    }
  }
}

/// "(0.5,0,0) none (0,0,2)" or "0.5 nan 2": of each axis its numbers, nan for what is none.
std::vector<std::vector<double>> directions_of(const std::string& text) {
  std::vector<std::vector<double>> directions;
  for (std::size_t at = 0; at < text.size();) {
    const bool vector = text[at] == '(';
    const std::size_t end = std::min(text.find(vector ? ')' : ' ', at), text.size());
    directions.emplace_back();
    for (const std::string& number : split(text.substr(at + (vector ? 1 : 0), end - at - (vector ? 1 : 0)), ',')) {
      const auto value = parse_number(number.substr(std::min(number.find_first_not_of(' '), number.size())));
      directions.back().push_back(value ? *value : std::nan(""));
    }
    at = std::min(text.find_first_not_of(' ', end + (vector ? 1 : 0)), text.size());
  }
  return directions;
}

std::vector<double> lengths_of(const std::string& text) {
  std::vector<double> lengths;
  for (const std::vector<double>& direction : directions_of(text)) {
    double squares = 0;
    for (const double value : direction) squares += value * value;
    lengths.push_back(std::sqrt(squares));
  }
  return lengths;
}

/// The axis of space that a direction is along, to a thousandth; none where it is oblique.
std::optional<std::size_t> axis_of(const std::vector<double>& direction) {
  constexpr double exact = 1e-3;
  std::size_t most = 0;
  for (std::size_t i = 1; i < direction.size(); ++i)
    if (std::abs(direction[i]) > std::abs(direction[most])) most = i;
  for (std::size_t i = 0; i < direction.size(); ++i)
    if (i != most && std::abs(direction[i]) > exact * std::abs(direction[most])) return std::nullopt;
  return most;
}

/// Of a volume whose directions are all stated in three dimensions.
void require_upright(const Bytes& bytes, const Fields& fields, bool ordered) {
  const auto found = fields.find("space directions");
  if (found == fields.end()) return;
  const std::vector<std::vector<double>> directions = directions_of(found->second);
  if (directions.size() != 3) return;
  std::string order;  // the slowest first, as --axes has it
  bool reversed = false;
  for (const std::vector<double>& direction : directions) {
    if (direction.size() != 3) return;
    for (const double value : direction)
      if (!std::isfinite(value)) return;
    const auto axis = axis_of(direction);
    if (!axis || order.find("xyz"[*axis]) != std::string::npos) {
      bytes.fail("its axes lie obliquely in space (space directions: " + excerpt(found->second) +
                 "); resample it to axes along x, y and z (3D Slicer: Resample Scalar/Vector/DWI Volume)");
    }
    order.insert(0, 1, "xyz"[*axis]);
    reversed = reversed || direction[*axis] < 0;
  }
  if (reversed) {
    bytes.fail("its axes run backwards (space directions: " + excerpt(found->second) +
               "), so that it would be read mirrored or turned; turn them: unu flip -a N for each such axis N, from 0");
  }
  if (order != "zyx" && !ordered) {
    bytes.fail("its axes are in another order (space directions: " + excerpt(found->second) + "); give --axes " +
               order);
  }
}

/// The words in quotes.
std::vector<std::string> quoted(const std::string& text) {
  const std::vector<std::string> pieces = split(text, '"');
  std::vector<std::string> words;
  for (std::size_t i = 1; i < pieces.size(); i += 2) words.push_back(pieces[i]);
  return words;
}

/// nan for a unit that is no length.
double mm_of(const std::string& unit) {
  constexpr std::pair<const char*, double> units[] = {
      {"", 1},           {"mm", 1},        {"millimeter", 1}, {"millimetre", 1}, {"um", 1e-3}, {"\u00b5m", 1e-3},
      {"\u03bcm", 1e-3}, {"micron", 1e-3}, {"nm", 1e-6},      {"cm", 10},        {"m", 1000},  {"in", 25.4}};
  for (const auto& [name, mm] : units) {
    if (unit == name) return mm;
  }
  return std::nan("");
}

std::vector<double> stated_mm(const Fields& fields, std::size_t axes) {
  const auto text = [&](const char* name) {
    const auto found = fields.find(name);
    return found == fields.end() ? std::string() : found->second;
  };
  const bool spaced = fields.count("spacings") != 0;
  std::vector<double> lengths = lengths_of(text(spaced ? "spacings" : "space directions"));
  const std::vector<std::string> units = quoted(text(spaced ? "units" : "space units"));
  if (lengths.size() != axes) return {};
  for (std::size_t i = 0; i < axes; ++i) lengths[i] *= mm_of(i < units.size() ? units[i] : "");
  const bool all = std::all_of(lengths.begin(), lengths.end(), [](double mm) { return std::isfinite(mm) && mm > 0; });
  return all ? lengths : std::vector<double>{};
}

}  // namespace

Head take_nrrd_head(Bytes& bytes, std::vector<double>& voxel_mm, bool ordered) {
  if (!bytes.line().starts_with(nrrd_magic)) bytes.fail("is no NRRD volume");
  const Fields fields = take_fields(bytes);
  require_plain(bytes, fields);
  require_upright(bytes, fields, ordered);
  Head head;
  set_type(bytes, field(bytes, fields, "type"), head);
  const std::vector<std::uint64_t> shape = shape_of(bytes, field(bytes, fields, "sizes"));
  const auto stated = fields.find("dimension");
  if (stated != fields.end() && stated->second != std::to_string(shape.size())) {
    bytes.fail("its header is damaged: dimension " + excerpt(stated->second) + ", but " + std::to_string(shape.size()) +
               " sizes" + remedy);
  }
  set_shape(bytes, shape, head);
  voxel_mm = stated_mm(fields, shape.size());
  head.big_endian = head.bytes > 1 && field(bytes, fields, "endian") == "big";
  const std::string& encoding = field(bytes, fields, "encoding");
  if (encoding == "gzip" || encoding == "gz") {
    bytes.unpack();
  } else if (encoding != "raw") {
    bytes.fail("has values encoded as " + excerpt(encoding) + "; raw and gzip are read" + remedy);
  }
  return head;
}

}  // namespace vam::io::arrays
