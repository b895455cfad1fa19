// The manual page in mdoc(7), clean under mandoc -Tlint: one sentence a line, ASCII, short lines.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>

#include "base/text.hpp"
#include "cli/declaration.hpp"

namespace vam::cli {

namespace {

constexpr int width = 78;
constexpr const char* date = "November 21, 2026";  // of the last change of the shared texts

// UTF-8 to roff's ASCII spelling; backslashes literal.
std::string escape(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const int extra = lead < 0x80 ? 0 : lead < 0xE0 ? 1 : lead < 0xF0 ? 2 : 3;
    if (extra == 0) {
      out += text[i] == '\\' ? std::string("\\e") : std::string(1, text[i]);
      ++i;
      continue;
    }
    std::uint32_t code = lead & (0x3FU >> extra);
    for (int k = 1; k <= extra && i + static_cast<std::size_t>(k) < text.size(); ++k) {
      code = (code << 6U) | (static_cast<unsigned char>(text[i + static_cast<std::size_t>(k)]) & 0x3FU);
    }
    char name[16];
    std::snprintf(name, sizeof name, "\\[u%04X]", code);
    out += name;
    i += static_cast<std::size_t>(extra) + 1;
  }
  return out;
}

// A text line must not start like a macro.
std::string guarded(const std::string& lines) {
  std::string out;
  for (const auto& line : split(lines, '\n')) {
    if (line.empty()) continue;
    if (line[0] == '.' || line[0] == '\'') out += "\\&";
    out += line + "\n";
  }
  return out;
}

std::string paragraph(const std::string& text) {
  std::string out;
  std::string sentence;
  const auto words = split(text, ' ');
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].empty()) continue;
    sentence += (sentence.empty() ? "" : " ") + words[i];
    const char last = words[i].back();
    const bool closing = (last == ')' || last == ']' || last == '"') && words[i].size() > 1;
    const char mark = closing ? words[i][words[i].size() - 2] : last;
    if (mark == '.' || mark == '?' || mark == '!' || i + 1 == words.size()) {
      out += guarded(wrap(escape(sentence), width, 0));
      sentence.clear();
    }
  }
  return out;
}

// A word on a macro line: no blank, nothing that mdoc would take for a macro.
std::string argument(const std::string& text) {
  std::string out = "\\&" + escape(text);
  return out.find(' ') == std::string::npos ? out : "\"" + out + "\"";
}

// ".Fl" puts the first dash; the rest follows.
std::string flag_words(const Option& option) {
  std::string out;
  for (const auto& name : split(option.flag, ',')) {
    if (!out.empty()) out += " , ";
    out += "Fl " + name.substr(1);
  }
  if (!option.value_name.empty()) out += " Ar " + argument(option.value_name);
  return out;
}

std::string option_list(const Declaration& tool) {
  std::string out;
  for (const auto& group : tool.groups) {
    if (tool.groups.size() > 1 || group.title != "Options") out += ".Ss " + group.title + "\n";
    out += ".Bl -tag -width Ds\n";
    for (const auto& option : group.options) {
      out += ".It " + flag_words(option) + "\n" + paragraph(option.help);
      if (!option.choices.empty()) out += paragraph("One of " + join(option.choices, ", ") + ".");
      if (!option.range_text.empty()) out += paragraph("Range: " + option.range_text + ".");
      if (!option.default_text.empty()) out += paragraph("Default: " + option.default_text + ".");
      if (option.repeatable) out += paragraph("May be repeated.");
    }
    out += ".El\n";
  }
  return out;
}

std::string positional_list(const Declaration& tool) {
  if (tool.positionals.empty()) return "";
  std::string out = ".Bl -tag -width Ds\n";
  for (const auto& positional : tool.positionals) {
    out += ".It Ar " + argument(positional.value_name) + "\n" + paragraph(positional.help);
  }
  return out + ".El\n";
}

std::string synopsis(const Declaration& tool) {
  std::string out;
  const auto line = [&](const Declaration& form, const std::string& command) {
    out += ".Nm\n";
    if (!command.empty()) out += ".Cm " + command + "\n";
    out += ".Op Ar OPTIONS\n";
    for (const auto& positional : form.positionals) {
      out += ".Op Ar " + argument(positional.value_name) + (positional.many ? " ...\n" : "\n");
    }
  };
  if (tool.subcommands.empty()) line(tool, "");
  for (const auto& nested : tool.subcommands) line(nested, nested.manual.name);
  return out;
}

std::string examples(const Manual& manual) {
  if (manual.examples.empty()) return "";
  std::string out = ".Sh EXAMPLES\n";
  for (const auto& [sentence, command] : manual.examples) {
    if (&sentence != &manual.examples.front().first) out += ".Pp\n";
    out += paragraph(sentence);
    out += ".Bd -literal -offset indent\n" + guarded(escape(command)) + ".Ed\n";
  }
  return out;
}

}  // namespace

std::string manual_page(const Declaration& tool) {
  const Manual& manual = tool.manual;
  std::string upper = manual.name;
  for (char& c : upper) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  std::string out = ".\\\" Printed by " + manual.name + " --man; do not edit.\n";
  out += std::string(".Dd ") + date + "\n.Dt " + upper + " 1\n.Os\n";
  out += ".Sh NAME\n.Nm " + manual.name + "\n.Nd " + escape(manual.summary) + "\n";
  out += ".Sh SYNOPSIS\n" + synopsis(tool);
  out += ".Sh DESCRIPTION\n";
  for (const auto& text : manual.description) {
    if (&text != &manual.description.front()) out += ".Pp\n";
    out += paragraph(text);
  }
  out += positional_list(tool);
  out += option_list(tool);
  for (const auto& nested : tool.subcommands) {
    out += ".Ss " + manual.name + " " + nested.manual.name + "\n" + paragraph(nested.manual.summary + ".");
    out += positional_list(nested);
    for (const auto& group : nested.groups) {
      Declaration one;
      one.groups = {{"Options", group.options}};
      if (nested.groups.size() > 1) out += ".Pp\n" + paragraph(group.title + ":");
      out += option_list(one);
    }
  }
  out +=
      ".Ss Help\n.Bl -tag -width Ds\n.It Fl h , Fl -help\nPrint a summary of the options.\n"
      ".It Fl -version\nPrint name and version.\n.It Fl -man\nPrint this page in\n.Xr mdoc 7 .\n"
      ".It Fl -completion Ar SHELL\nPrint the completion script for bash, zsh or fish.\n.El\n";
  for (const auto& note : manual.notes) {
    if (&note == &manual.notes.front())
      out += ".Sh IMPLEMENTATION NOTES\n";
    else
      out += ".Pp\n";
    out += paragraph(note);
  }
  out +=
      ".Sh ENVIRONMENT\n.Bl -tag -width Ds\n"
      ".It Ev VAM_PRINTER\nThe printer file, when no\n.Fl -printer\nis given.\n"
      ".It Ev VAM_SIMD\nHighest instruction set to use: baseline, avx2 or avx512.\n.El\n";
  out +=
      ".Sh FILES\n"
      "Volumes are OpenVDB float grids in mm with the rotation axis at x = y = 0.\n"
      "Stacks are multi-part scanline OpenEXR files with one channel Y.\n"
      "A dash means standard input or standard output; outputs appear under their\n"
      "final name only when complete.\n"
      "Settings of the printer are read from a TOML file.\n";
  for (const auto& file : manual.files) out += ".Pp\n" + paragraph(file);
  out += ".Sh EXIT STATUS\n.Bl -tag -width Ds\n";
  for (const auto& status : exit_statuses()) out += ".It " + std::to_string(status.code) + "\n" + status.meaning + "\n";
  out += ".El\n";
  out += examples(manual);
  std::vector<std::string> others = manual.see_also;
  std::sort(others.begin(), others.end());
  if (!others.empty()) {
    out += ".Sh SEE ALSO\n";
    for (const auto& name : others) out += ".Xr " + name + " 1" + (&name == &others.back() ? "\n" : " ,\n");
  }
  return out;
}

}  // namespace vam::cli
