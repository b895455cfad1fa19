// SPDX-License-Identifier: GPL-3.0-or-later
// Printer settings as text: the whole file, what differs from the defaults, and whether a file is cut off.
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>
#include <vector>

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
  for (std::string* file : {&printer.projector.response, &printer.projector.flat, &printer.camera.flat}) {
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

namespace {

// A file of fewer is taken for the few settings that somebody wanted to change.
constexpr int most_keys_of_a_note = 9;

bool has_line(std::string_view text, std::string_view line) {
  return text.starts_with(line) || text.find("\n" + std::string(line)) != std::string_view::npos;
}

// Its headings, in the order of the file, and its settings.
struct Outline {
  bool version = false;  // of the format is stated
  std::vector<std::string> headings;
  int keys = 0;
  int keys_of_last = 0;
};

Outline outline_of(std::string_view text) {
  Outline outline;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = trimmed(text.substr(at, end - at));
    at = end + 1;
    if (line.starts_with('[')) {
      outline.headings.push_back(trimmed(std::string_view(line).substr(1, line.find(']') - 1)));
      outline.keys_of_last = 0;
    } else if (outline.headings.empty() && line.starts_with("version")) {
      outline.version = true;
    } else if (!line.starts_with('#') && line.find('=') != std::string_view::npos) {
      ++outline.keys;
      ++outline.keys_of_last;
    }
  }
  return outline;
}

std::string bracketed(const std::string& section) { return "[" + section + "]"; }

std::vector<std::string> absent(const Outline& outline) {
  std::vector<std::string> sections;
  for (const std::string& section : section_names()) {
    const bool there = std::find(outline.headings.begin(), outline.headings.end(), section) != outline.headings.end();
    if (!there) sections.push_back(bracketed(section));
  }
  return sections;
}

// What a cut leaves of a file whose sections are in the order in which they are printed and explained.
bool ends_before_the_last_section(const Outline& outline) {
  const auto all = section_names();
  const auto place = [&](const std::string& section) { return std::find(all.begin(), all.end(), section); };
  const auto& headings = outline.headings;
  const bool note = outline.keys <= most_keys_of_a_note;
  return !note && !headings.empty() && headings.back() != all.back() &&
         std::is_sorted(headings.begin(), headings.end(),
                        [&](const std::string& a, const std::string& b) { return place(a) < place(b); });
}

}  // namespace

// A file that ends within its first line has lost the rest of it, too.
void require_own_end(std::string_view text, const std::string& subject) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  const bool ours = has_line(text, printer_head) || (!text.empty() && printer_head.starts_with(text));
  if (!ours || has_line(text, printer_end)) return;
  throw Error{Fault::data, subject + ": is cut off after " + std::to_string(text.size()) + " bytes, it has no line '" +
                               std::string(printer_end) + "'; write it again"};
}

std::string sign_of_cut(std::string_view text) {
  if (text.empty() || has_line(text, printer_end)) return "";
  const Outline outline = outline_of(text);
  std::string sign;
  std::string remedy;
  if (text.back() != '\n') {
    sign = "ends within a line";
    remedy = "complete its last line";
  } else if (outline.version && outline.headings.empty() && outline.keys == 0) {
    sign = "ends after its version";
    remedy = "add what is missing, or delete the version";
  } else if (!outline.headings.empty() && outline.keys_of_last == 0) {
    sign = "ends with the heading " + bracketed(outline.headings.back());
    remedy = "add what is missing, or delete the heading";
  } else if (ends_before_the_last_section(outline)) {
    sign = "ends after " + bracketed(outline.headings.back());
    remedy = "add what is missing, or the last line '" + std::string(printer_end) + "' if nothing is";
  } else {
    return "";
  }
  const auto missing = absent(outline);
  return sign + ", as if it was cut off" + (missing.empty() ? "" : ", without " + join(missing, ", ")) + "; " + remedy;
}

std::vector<std::string> changed_settings(model::Printer then, model::Printer now) {
  std::vector<std::string> changed;
  for (const auto& field : printer_fields()) {
    const auto text = [&](model::Printer& printer) {
      const std::string value = std::visit(FieldText{}, field.slot(printer));
      return value.empty() ? "not set" : value;
    };
    if (const std::string before = text(then), after = text(now); before != after)
      changed.push_back(dotted_name(field) + " " + before + ", now " + after);
  }
  return changed;
}

}  // namespace vam::io
