// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of words as a table for other programs.
#include <string_view>

#include "base/text/text.hpp"
#include "vam-score/outputs.hpp"

namespace vam::score_tool {

namespace {

std::string escaped(const std::string& cell, const std::string& special, const std::string& escape) {
  std::string text;
  for (const char c : cell) text += (special.find(c) == std::string::npos ? "" : escape) + std::string(1, c);
  return text;
}

/// A cell with a comma, a quote or a line break stands in quotes, its quotes twice.
std::string csv_cell(const std::string& cell) {
  return cell.find_first_of(",\"\n") == std::string::npos ? cell : '"' + escaped(cell, "\"", "\"") + '"';
}

std::string latex_cell(const std::string& cell) {
  std::string text;
  for (const char c : cell) {
    const std::string_view word = c == '\\' ? "backslash" : c == '~' ? "asciitilde" : c == '^' ? "asciicircum" : "";
    text += word.empty() ? escaped(std::string(1, c), "_&%#${}", "\\") : "\\text" + std::string(word) + "{}";
  }
  return text;
}

}  // namespace

std::string text_of(const Table& table, const std::string& form) {
  const bool is_csv = form == "csv", is_latex = form == "latex";
  std::string text, rule = is_csv ? "" : is_latex ? "\\hline\n" : "|---", columns;
  for (const auto& row : table) {
    std::vector<std::string> cells;
    for (const auto& cell : row)
      cells.push_back(is_csv ? csv_cell(cell) : is_latex ? latex_cell(cell) : escaped(cell, "|", "\\"));
    text += is_csv     ? join(cells, ",") + "\n"
            : is_latex ? join(cells, " & ") + " \\\\\n"
                       : "| " + join(cells, " | ") + " |\n";
    if (&row != &table.front()) continue;
    columns = std::string(row.size() - 1, 'r');
    for (std::size_t n = 1; n < row.size() && rule.starts_with('|'); ++n) rule += "|---:";
    text += rule + (rule.starts_with('|') ? "|\n" : "");
  }
  return is_latex ? "\\begin{tabular}{l" + columns + "}\n" + text + "\\end{tabular}\n" : text;
}

}  // namespace vam::score_tool
