// SPDX-License-Identifier: GPL-3.0-or-later
// Printer settings as text: the whole file, and what differs from the defaults.
#include <toml++/toml.h>

#include <charconv>
#include <filesystem>
#include <sstream>

#include "base/error.hpp"
#include "base/text/format_version.hpp"
#include "base/text/text.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/private/printer_fields.hpp"

namespace vam::io {

namespace {

// Shortest decimal form that reads back to the same double, with the point that TOML wants in a float.
std::string decimal(double value) {
  char text[32];
  char* const end = std::to_chars(text, text + sizeof text, value).ptr;
  std::string shortest(static_cast<char*>(text), end);
  return shortest.find_first_of(".e") == std::string::npos ? shortest + ".0" : shortest;
}

struct FieldText {
  std::string operator()(const int* value) const { return std::to_string(*value); }
  std::string operator()(const double* value) const { return decimal(*value); }
  std::string operator()(const std::optional<double>* value) const { return *value ? decimal(**value) : ""; }
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const std::string* value) const {
    std::ostringstream quoted;
    quoted << toml::toml_formatter{toml::value<std::string>(*value), toml::format_flags::none};
    return quoted.str();
  }
};

}  // namespace

bool has_setting(const model::Printer& given, const std::string& name) {
  model::Printer printer = given;
  for (const auto& field : printer_fields()) {
    const auto is_there = [](const auto* value) { return *value != std::remove_cvref_t<decltype(*value)>{}; };
    if (dotted_name(field) == name) return std::visit(is_there, field.slot(printer));
  }
  throw Error{Fault::bug, name + ": is no setting of the printer"};
}

std::string printer_toml(const model::Printer& given) {
  model::Printer printer = given;
  std::ostringstream text;
  text << printer_head << "\n# Every setting is here; delete what should keep its default.\n"
       << "version = " << FormatKind("printer file").version()
       << "                         # of the format of this file\n";
  std::string section;
  for (const auto& field : printer_fields()) {
    if (section != field.section) text << "\n[" << (section = field.section) << "]\n";
    std::string value = std::visit(FieldText{}, field.slot(printer));
    std::string line = value.empty() ? "# " + std::string(field.key) + " =" : std::string(field.key) + " = " + value;
    constexpr std::size_t comment_column = 34;
    if (line.size() < comment_column) line.append(comment_column - line.size(), ' ');
    text << line << "  # " << field.comment << (value.empty() ? " (not set)" : "") << '\n';
  }
  text << '\n' << printer_end << '\n';
  return text.str();
}

model::Printer frozen(model::Printer printer) {
  for (std::string* file : {&printer.projector.response, &printer.camera.flat}) {
    if (!file->empty()) *file = std::filesystem::absolute(*file).lexically_normal().string();
  }
  printer.calibration.folder.clear();
  return printer;
}

std::string printer_settings(const model::Printer& given) {
  model::Printer printer = frozen(given);
  model::Printer standard;
  std::vector<std::string> settings;
  for (const auto& field : printer_fields()) {
    const std::string value = std::visit(FieldText{}, field.slot(printer));
    if (value != std::visit(FieldText{}, field.slot(standard))) settings.push_back(dotted_name(field) + "=" + value);
  }
  return settings.empty() ? "default" : join(settings, " ");
}

}  // namespace vam::io
