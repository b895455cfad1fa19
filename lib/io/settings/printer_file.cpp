// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/printer_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/printer_path.hpp"
#include "base/system_error.hpp"
#include "base/text/format_version.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "io/settings/calibration_record.hpp"
#include "io/settings/private/printer_fields.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/file_type.hpp"

namespace vam::io {

namespace {

using model::Printer;

constexpr std::size_t most_file_bytes = std::size_t{1} << 18;
constexpr std::ptrdiff_t most_levels = 4096;

const PrinterField* find_field(std::string_view section, std::string_view key) {
  for (const auto& field : printer_fields()) {
    if (section == field.section && key == field.key) return &field;
  }
  return nullptr;
}

// "; did you mean radius_mm?" within the section, else the same key in the section of the nearest name, else in another
// section, else all that there is.
std::string suggestion(std::string_view section, std::string_view key) {
  if (const PrinterField* meant = find_field(nearest(section, section_names()), key); meant != nullptr) {
    return "; did you mean " + dotted_name(*meant) + "?";
  }
  std::vector<std::string> here;
  for (const auto& field : printer_fields()) {
    if (section == field.section) here.emplace_back(field.key);
    if (key == field.key) return "; did you mean " + dotted_name(field) + "?";
  }
  std::string close = did_you_mean(key, here);
  if (!close.empty()) return close;
  if (!here.empty()) return "; [" + std::string(section) + "] has " + join(here, ", ");
  const std::string near_section = did_you_mean(section, section_names());
  return near_section.empty() ? "; the sections are " + join(section_names(), ", ") : near_section;
}

const char* type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a decimal number";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "a list";
    default:
      return "a date or time";
  }
}

// Stores the node when its type fits; otherwise returns what was needed. Whole numbers serve as decimal ones.
struct Store {
  const toml::node& node;
  const char* operator()(int* target) const {
    const auto value = node.is_integer() ? node.value<int>() : std::nullopt;
    if (value) *target = *value;
    return value ? nullptr : "a whole number";
  }
  const char* operator()(double* target) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (value) *target = *value;
    return value ? nullptr : "a number";
  }
  const char* operator()(std::optional<double>* target) const {
    double value = 0;
    const char* needed = (*this)(&value);
    if (needed == nullptr) *target = value;
    return needed;
  }
  const char* operator()(bool* target) const {
    if (node.is_boolean()) *target = *node.value<bool>();
    return node.is_boolean() ? nullptr : "true or false";
  }
  const char* operator()(std::string* target) const {
    if (node.is_string()) *target = *node.value<std::string>();
    return node.is_string() ? nullptr : "text in quotes";
  }
};

void assign(Printer& printer, const PrinterField& field, const toml::node& node, Fault fault,
            const std::string& place) {
  const Slot slot = field.slot(printer);
  if (std::holds_alternative<int*>(slot) && node.is_integer() && !node.value<int>()) {
    throw Error{fault, place + ": " + dotted_name(field) + ": " +
                           objection_to_whole(field, std::to_string(*node.value<std::int64_t>()))};
  }
  if (const char* needed = std::visit(Store{node}, slot)) {
    throw Error{fault, place + ": " + dotted_name(field) + " must be " + needed + ", not " + type_name(node)};
  }
  if (const std::string why = objection(field, slot); !why.empty()) {
    throw Error{fault, place + ": " + dotted_name(field) + ": " + why};
  }
}

std::string place(const std::string& subject, const toml::source_region& region) {
  return subject + ":" + std::to_string(region.begin.line);
}

void read_section(Printer& printer, const toml::table& table, std::string_view section, const std::string& subject) {
  for (const auto& [key, node] : table) {
    const std::string where = place(subject, key.source());
    const PrinterField* field = find_field(section, key.str());
    if (field == nullptr) {
      throw Error{Fault::data, where + ": unknown key " + excerpt(key.str()) + " in [" + std::string(section) + "]" +
                                   suggestion(section, key.str())};
    }
    assign(printer, *field, node, Fault::data, where);
  }
}

// First: a later version may have other keys.
void require_version(const toml::table& root, const std::string& subject) {
  const toml::node* version = root.get("version");
  if (version == nullptr) return;
  std::ostringstream stated;
  version->visit([&](const auto& value) { stated << value; });
  if (const std::string why = FormatKind("printer file").objection(stated.str()); !why.empty())
    throw Error{Fault::data, place(subject, version->source()) + ": " + why};
}

void read_table(Printer& printer, const toml::table& root, const std::string& subject) {
  require_version(root, subject);
  for (const auto& [key, node] : root) {
    if (key == "version") continue;
    const std::string where = place(subject, key.source());
    const auto names = section_names();
    if (std::find(names.begin(), names.end(), key.str()) == names.end()) {
      const std::string hint = node.is_table() ? suggestion(key.str(), "") : suggestion("", key.str());
      throw Error{Fault::data,
                  where + ": unknown " + (node.is_table() ? "section" : "key") + " " + excerpt(key.str()) + hint};
    }
    if (!node.is_table()) {
      throw Error{Fault::data, where + ": " + excerpt(key.str()) + " must be a section, not " + type_name(node)};
    }
    read_section(printer, *node.as_table(), key.str(), subject);
  }
}

bool is_whole(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  return !text.empty() && text.find_first_not_of("0123456789_") == text.npos;
}

// A whole number of more than 64 bits is no TOML; its key and limits, where the line has one, else nothing.
std::string beyond_64_bits(std::string_view text, std::size_t number) {
  const auto trimmed = [](std::string_view words) {
    words = words.substr(std::min(words.find_first_not_of(" \t"), words.size()));
    return words.substr(0, words.find_last_not_of(" \t\r") + 1);
  };
  std::string_view section, line;
  for (std::size_t n = 1, begin = 0; n <= number && begin < text.size(); ++n) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    line = trimmed(text.substr(begin, end - begin));
    if (line.starts_with('[')) section = trimmed(line.substr(1, std::min(line.find(']'), line.size()) - 1));
    begin = end + 1;
  }
  const std::size_t equals = std::min(line.find('='), line.size());
  const PrinterField* field = find_field(section, trimmed(line.substr(0, equals)));
  if (field == nullptr || equals == line.size()) return "";
  const std::string_view value = line.substr(equals + 1);
  const std::string digits(trimmed(value.substr(0, value.find('#'))));
  return is_whole(digits) ? dotted_name(*field) + ": " + objection_to_whole(*field, digits) : "";
}

// Each level of nesting takes one of these, and the parser and its tables a piece of the stack for each level.
void check_depth(std::string_view text, const std::string& subject) {
  const auto count = std::count_if(text.begin(), text.end(), [](char c) { return c == '.' || c == '[' || c == '{'; });
  if (count <= most_levels) return;
  throw Error{Fault::data, subject + ": has " + std::to_string(count) +
                               " dots and brackets; the limit for a printer file is " + std::to_string(most_levels)};
}

// The reading half of parse_printer, before settings are compared with one another: --set may still mend them.
Printer read_settings(std::string_view text, const std::string& subject) {
  if (const std::string foreign = foreign_format(text); !foreign.empty()) {
    throw Error{Fault::data, subject + ": is " + foreign + ", not a printer file"};
  }
  require_own_end(text, subject);
  check_depth(text, subject);
  const toml::table root = [&] {
    try {
      return toml::parse(text, subject);
    } catch (const toml::parse_error& error) {
      const std::string beyond = beyond_64_bits(text, error.source().begin.line);
      throw Error{Fault::data, place(subject, error.source()) + ": " +
                                   (beyond.empty() ? "not TOML: " + std::string(error.description()) : beyond)};
    }
  }();
  Printer printer = without_axis();
  read_table(printer, root, subject);
  return printer;
}

void check(const Printer& printer, Fault fault, const std::string& subject) {
  if (const std::string why = contradiction(printer); !why.empty()) throw Error{fault, subject + ": " + why};
}

// {value = ...}, also of a number that TOML writes with more digits (.15), or an empty table.
toml::table parse_value(const std::string& value) {
  if (value.size() > static_cast<std::size_t>(most_levels)) return {};
  try {
    return toml::parse("value = " + value);
  } catch (const toml::parse_error&) {
    const auto number = is_whole(value) ? std::nullopt : parse_number(value);
    return number && std::isfinite(*number) ? toml::table{{"value", *number}} : toml::table{};
  }
}

void override_one(Printer& printer, const std::string& set) {
  const std::string& subject = set;
  const std::size_t equals = set.find('=');
  const std::string name = set.substr(0, equals);
  const std::size_t dot = name.find('.');
  if (equals == std::string::npos || dot == std::string::npos) {
    throw Error{Fault::usage, subject + ": not section.key=value; for example vial.radius_mm=12"};
  }
  const PrinterField* field = find_field(name.substr(0, dot), name.substr(dot + 1));
  if (field == nullptr) {
    throw Error{Fault::usage, subject + ": unknown setting" + suggestion(name.substr(0, dot), name.substr(dot + 1))};
  }
  const std::string value = set.substr(equals + 1);
  const toml::table parsed = parse_value(value);
  const toml::node* node = parsed.get("value");
  const toml::value<std::string> bare(value);
  if (std::holds_alternative<std::string*>(field->slot(printer))) {  // quotes are optional around text
    if (node == nullptr || !node->is_string()) node = &bare;
  } else if (node == nullptr && is_whole(value)) {
    throw Error{Fault::usage, subject + ": " + objection_to_whole(*field, value)};
  } else if (node == nullptr || parsed.size() != 1) {
    throw Error{Fault::usage, subject + ": '" + value + "' is not a value"};
  }
  assign(printer, *field, *node, Fault::usage, subject);
  model::Resin& resin = printer.resin;  // what is set last states the absorption
  if (name == "resin.absorption_per_mm") resin.initiator_mmol_l = resin.extinction_l_mol_cm = std::nullopt;
  if (name == "resin.initiator_mmol_l" || name == "resin.extinction_l_mol_cm") resin.absorption_per_mm = 0;
}

/// The built-in value of a setting that a preset should have is no property of that printer.
void warn_of_unpublished(const std::vector<std::string>& keys, const std::vector<std::string>& sets,
                         const std::string& preset, Printer printer) {
  const auto has_value = [](const auto* value) {
    if constexpr (requires { value->has_value(); }) return value->has_value();
    return true;
  };
  std::vector<std::string> assumed;
  for (const PrinterField& field : printer_fields()) {
    const std::string key = dotted_name(field);
    const auto is_it = [&](const std::string& set) { return set.starts_with(key + "="); };
    if (std::find(keys.begin(), keys.end(), key) == keys.end() || std::any_of(sets.begin(), sets.end(), is_it))
      continue;
    if (std::visit(has_value, field.slot(printer))) assumed.push_back(key);
  }
  if (assumed.empty()) return;
  warn(preset + ": " + join(assumed, ", ") + (assumed.size() == 1 ? " is" : " are") +
       " not published, and taken from the built-in printer; give yours by --set or in a file (--print-printer)");
}

/// Of "opencal,vial-17" the first name that is none.
std::string suggested_preset(const std::string& names) {
  for (const std::string& name : split(names, ',')) {
    if (!is_preset(name)) return did_you_mean(name, preset_names());
  }
  return "";
}

std::string slurp(const std::string& file) {
  if (file == "-") throw Error{Fault::usage, "-: printer settings are not read from standard input; name a file"};
  if (std::filesystem::is_directory(file)) throw Error{Fault::no_input, file + ": is a folder, not a printer file"};
  std::ifstream stream(file, std::ios::binary);
  std::string text(most_file_bytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(stream.gcount());
  if (!stream.is_open() && file.find_first_of("./") == std::string::npos) {
    throw Error{Fault::no_input,
                file + ": is no file, and no preset" + suggested_preset(file) + "; vam-plan --printers lists them"};
  }
  if (!stream.is_open() || stream.bad()) {
    throw system_error(Fault::no_input, file + ": cannot open", errno);
  }
  if (text.size() > most_file_bytes)
    throw Error{Fault::data, file + ": is longer than 256 KiB; it is not a printer file"};
  return text;
}

void refuse_empty(const std::string& text, const std::string& file) {
  if (!text.empty() || !std::filesystem::is_regular_file(file)) return;
  throw Error{Fault::data, file + ": is empty; write it again, or delete it for the defaults"};
}

}  // namespace

bool has_printer_section(std::string_view text) {
  const auto names = section_names();
  const std::string lines = "\n" + std::string(text);
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return lines.find("\n[" + name + "]") != std::string::npos; });
}

Printer parse_printer(std::string_view toml, const std::string& subject, const std::vector<std::string>& sets) {
  Printer printer = read_settings(toml, subject);
  for (const auto& set : sets) override_one(printer, set);
  settle(printer);
  check(printer, sets.empty() ? Fault::data : Fault::usage, subject);
  return printer;
}

Printer load_printer(const std::string& file, const std::vector<std::string>& sets, Records records) {
  const std::string path = printer_path(file);
  Printer printer = without_axis();
  PresetSettings preset;
  if (is_preset(path)) {
    preset = preset_settings(path);
    for (const auto& set : preset.sets) override_one(printer, set);
  } else if (!path.empty()) {
    const std::string text = slurp(path);
    const bool sealed = require_text_seal(text, path);
    printer = read_settings(text, path);
    refuse_empty(text, path);
    if (const std::string sign = sign_of_cut(text); !sealed && !sign.empty()) warn(path + ": " + sign);
    const auto beside = std::filesystem::path(path).parent_path();
    for (std::string* file_name :
         {&printer.projector.response, &printer.projector.flat, &printer.camera.flat, &printer.calibration.folder}) {
      if (!file_name->empty()) *file_name = (beside / *file_name).string();
    }
  }
  if (records == Records::apply) {
    Printer settled = printer;  // --set may name the records
    for (const auto& set : sets) override_one(settled, set);
    apply_records(printer, settled.calibration, utc_seconds());
  }
  for (const auto& set : sets) override_one(printer, set);
  settle(printer);
  warn_of_unpublished(preset.unpublished, sets, path, printer);
  std::string subject = path;  // with several --set any of them may be the cause
  if (path.empty() && !sets.empty()) subject = sets.size() == 1 ? sets.front() : "printer settings";
  check(printer, sets.empty() ? Fault::data : Fault::usage, subject);
  return printer;
}

}  // namespace vam::io
