// SPDX-License-Identifier: GPL-3.0-or-later
// Small tables of measurements: CSV with a header line, for working curves, photodiode readings and catalogues.
#pragma once

#include <string>
#include <vector>

namespace vam::io {

/// Cells in the order of the requested columns.
struct CsvTable {
  std::string source;  // file name, for messages
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::vector<int> lines;  // line number of each row

  /// Throws Fault::data with file, line and column when the cell is not a finite number.
  [[nodiscard]] double number(std::size_t row, std::size_t column) const;
  [[nodiscard]] std::vector<double> column(std::size_t column) const;
};

/// Reads the named columns, in whatever order the header has them; further columns are ignored. Without names, all that
/// the header has, which must be there. Lines that are empty or
/// begin with # are skipped. A file whose first line is all numbers has no header: its columns are taken in the order
/// given here. "-" is stdin. Throws Error:
/// no_input, io, data (a column missing, a row too short, no rows).
[[nodiscard]] CsvTable read_csv(const std::string& path, const std::vector<std::string>& columns);

}  // namespace vam::io
