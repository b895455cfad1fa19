// SPDX-License-Identifier: GPL-3.0-or-later
// The manual page in mdoc(7), clean under mandoc -Tlint: one sentence a line, ASCII, short lines.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <set>
#include <string>

#include "base/text/text.hpp"
#include "cli/private/declaration.hpp"

namespace vam::cli {

namespace {

constexpr int text_width = 78;

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
      code = (code << 6U) | (static_cast<unsigned char>(text[i + k]) & 0x3FU);
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

/// Words that end with a full stop inside of a sentence.
bool abbreviated(const std::string& word) {
  static const std::set<std::string> known = {"al.",  "Adv.", "Appl.", "Comput.", "Mater.",
                                              "Opt.", "e.g.", "i.e.",  "vs."};
  return known.count(word) > 0;
}

std::string paragraph(const std::string& text) {
  std::string out;
  std::string sentence;
  const auto words = split(text, ' ');
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].empty()) continue;
    sentence += (sentence.empty() ? "" : " ") + escape(words[i]);
    if (abbreviated(words[i])) sentence += "\\&";  // no end of a sentence
    const char last = words[i].back();
    const bool closing = (last == ')' || last == ']' || last == '"') && words[i].size() > 1;
    const char mark = closing ? words[i][words[i].size() - 2] : last;
    const bool ends = (mark == '.' && !abbreviated(words[i])) || mark == '?' || mark == '!';
    if (ends || i + 1 == words.size()) {
      out += guarded(wrap(sentence, text_width, 0));
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
  if (!option.value_name.empty()) out += (option.implicit.empty() ? " Ar " : " Op Ar ") + argument(option.value_name);
  return out;
}

std::string option_items(const std::vector<Option>& options) {
  std::string out;
  for (const auto& option : options) {
    out += ".It " + flag_words(option) + "\n";
    for (const auto& text : details(option)) out += paragraph(text);
  }
  return out;
}

std::string option_list(const Declaration& tool) {
  std::string out;
  for (const auto& group : tool.groups) {
    if (tool.groups.size() > 1 || group.title != "Options") out += ".Ss " + group.title + "\n";
    out += ".Bl -tag -width Ds\n" + option_items(group.options) + ".El\n";
  }
  return out;
}

std::string positional_list(const Declaration& tool) {
  if (tool.positionals.empty()) return "";
  std::string out = ".Bl -tag -width Ds\n";
  for (const auto& positional : tool.positionals) {
    out += ".It Ar " + argument(positional.value_name) + "\n" + paragraph(details(positional));
  }
  return out + ".El\n";
}

std::string synopsis(const Declaration& tool) {
  std::string out;
  const auto lines = [&](const Declaration& declared, const std::string& command) {
    for (const auto& form : forms_of(declared)) {
      out += ".Nm\n";
      if (!command.empty()) out += ".Cm " + command + "\n";
      if (!form.groups.empty()) out += ".Op Ar OPTIONS\n";
      for (const auto& option : required_options(form)) out += "." + flag_words(option) + "\n";
      for (const auto& positional : form.positionals) {
        out += (positional.default_text.empty() ? ".Ar " : ".Op Ar ") + argument(positional.value_name) + "\n";
      }
    }
  };
  if (has_plain_form(tool)) lines(tool, "");
  for (const auto& nested : tool.subcommands) lines(nested, nested.manual.name);
  return out;
}

// What makes two options the same for a reader.
std::string printed(const Option& option) { return flag_words(option) + "\n" + join(details(option), "\n"); }

std::vector<Option> grouped_options(const Declaration& form) {
  std::vector<Option> options;
  for (const auto& group : form.groups) options.insert(options.end(), group.options.begin(), group.options.end());
  return options;
}

// Options that several commands declare alike and the plain form does not: printed once, before the commands.
Group shared_options(const Declaration& tool) {
  std::map<std::string, int> uses;
  for (const auto& nested : tool.subcommands) {
    for (const auto& option : grouped_options(nested)) ++uses[printed(option)];
  }
  for (const auto& option : grouped_options(tool)) uses.erase(printed(option));
  Group common{"Options of several commands", {}};
  for (const auto& nested : tool.subcommands) {
    for (const auto& option : grouped_options(nested)) {
      if (uses[printed(option)] < 2) continue;
      common.options.push_back(option);
      uses[printed(option)] = 0;
    }
  }
  return common;
}

// A command's own options in full, the names of those that are printed above.
std::string command_options(const Declaration& nested, const std::set<std::string>& above) {
  std::string out;
  std::vector<std::string> names;
  for (const auto& group : nested.groups) {
    Group own{"Options", {}};
    for (const auto& option : group.options) {
      if (above.count(printed(option)) == 0)
        own.options.push_back(option);
      else
        names.push_back(long_flag(option));
    }
    if (own.options.empty()) continue;
    Declaration one;
    one.groups = {own};
    if (nested.groups.size() > 1) out += ".Pp\n" + paragraph(group.title + ":");
    out += option_list(one);
  }
  if (names.empty()) return out;
  return out + ".Pp\n" + paragraph("Options described above: " + join(names, ", ") + ".");
}

std::string sentence(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text + ".";
}

std::string commands(const Declaration& tool) {
  std::string out;
  Declaration shared;
  shared.groups = {shared_options(tool)};
  std::set<std::string> above;
  for (const auto& option : grouped_options(tool)) above.insert(printed(option));
  for (const auto& option : grouped_options(shared)) above.insert(printed(option));
  if (!shared.groups[0].options.empty()) out += option_list(shared);
  for (const auto& nested : tool.subcommands) {
    out += ".Ss " + tool.manual.name + " " + nested.manual.name + "\n" + paragraph(sentence(nested.manual.summary));
    out += positional_list(nested) + command_options(nested, above);
  }
  return out;
}

std::string environment(const Declaration& tool) {
  std::string out;
  if (find_option(tool, "--printer") != nullptr)
    out += ".It Ev VAM_PRINTER\nThe printer file, when\n.Fl -printer\nis not given.\n";
  if (find_option(tool, "--threads") != nullptr)
    out += ".It Ev VAM_SIMD\nHighest instruction set to use: baseline, avx2 or avx512.\n";
  const auto& statuses = tool.manual.statuses;
  const bool drives = std::any_of(statuses.begin(), statuses.end(), [](const auto& s) { return s.code == 76; });
  if (drives || tool.manual.locks)
    out +=
        ".It Ev VAM_LOCK_DIR\nFolder of the locks that reserve a device for one program.\nDefault:\n"
        ".Pa /run/lock ,\nelse\n.Pa /tmp .\n";
  return out.empty() ? "" : ".Sh ENVIRONMENT\n.Bl -tag -width Ds\n" + out + ".El\n";
}

std::string files_section() {
  return ".Sh FILES\n"
         "The formats of volumes, stacks, records and the printer file are described in\n"
         ".Xr vam-formats 7 .\n"
         "A dash means standard input or standard output; outputs appear under their\n"
         "final name only when complete.\n";
}

std::string head(const Manual& manual) {
  std::string upper = manual.name;
  for (char& c : upper) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  return ".Dt " + upper + " 1\n.Os\n.Sh NAME\n.Nm " + manual.name + "\n.Nd " + escape(manual.summary) + "\n";
}

std::string every_tool(const Declaration& tool) {
  return ".Ss Common options\n.Bl -tag -width Ds\n" + option_items(common_options()) +
         ".It Fl h , Fl -help\nPrint a summary of the " +
         (has_usual(tool) ? "usual options;\n.Fl -help Ns = Ns Cm all ,\nof all.\n" : "options.\n") +
         ".It Fl -version\nPrint name and version.\n.It Fl -man\nPrint this page in\n.Xr mdoc 7 .\n"
         ".It Fl -completion Ar SHELL\nPrint the completion script for bash, zsh or fish.\n.El\n";
}

std::string paragraphs(const std::vector<std::string>& texts) {
  std::string out;
  for (const auto& text : texts) {
    if (!out.empty()) out += ".Pp\n";
    out += paragraph(text);
  }
  return out;
}

std::string exit_status(const Declaration& tool) {
  std::string out = ".Sh EXIT STATUS\n.Bl -tag -width Ds\n";
  for (const auto& status : exit_statuses(tool))
    out += ".It " + std::to_string(status.code) + "\n" + status.meaning + "\n";
  return out + ".El\n";
}

using Blocks = std::vector<std::pair<std::string, std::string>>;  // name and lines

Blocks blocks_of(const Declaration& tool) {
  const bool has_files = find_option(tool, "--printer") != nullptr || find_option(tool, "--output") != nullptr ||
                         !tool.positionals.empty();
  Blocks blocks{{"name", head(tool.manual)},
                {"synopsis", ".Sh SYNOPSIS\n" + synopsis(tool)},
                {"options", positional_list(tool) + option_list(tool) + commands(tool) + every_tool(tool)},
                {"environment", environment(tool)},
                {"files", has_files ? files_section() : ""},
                {"status", exit_status(tool)}};
  for (const auto& [name, texts] : tool.manual.lists) blocks.emplace_back(name, paragraphs(texts));
  return blocks;
}

// ".\" <options>" and ".\" </options>"
std::string mark(const std::string& name) { return ".\\\" <" + name + ">\n"; }

}  // namespace

std::string printed_manual(const Declaration& tool) {
  std::string page = tool.manual.page;
  for (const auto& [name, lines] : blocks_of(tool)) {
    const std::string begin = mark(name);
    if (tool.manual.page.empty()) page += begin + lines + mark("/" + name);
    const std::size_t from = page.find(begin);
    const std::size_t end = page.find(mark("/" + name));
    if (from == std::string::npos || end == std::string::npos) continue;  // a page that has no use for it
    page.replace(from + begin.size(), end - from - begin.size(), lines);
  }
  return page;
}

}  // namespace vam::cli
