// SPDX-License-Identifier: GPL-3.0-or-later
// Which printer file is in use: the one that is given, else $VAM_PRINTER, else ./printer.toml, else none. The empty one
// that the shell makes for `vam-slice --print-printer > printer.toml` is none.
#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace vam {

inline std::string printer_path(const std::string& given) {
  if (!given.empty()) return given;
  if (const char* named = std::getenv("VAM_PRINTER"); named != nullptr && *named != '\0') return named;
  struct stat file = {};
  struct stat output = {};
  if (stat("printer.toml", &file) != 0) return "";
  const bool made_by_shell = file.st_size == 0 && fstat(STDOUT_FILENO, &output) == 0 && file.st_dev == output.st_dev &&
                             file.st_ino == output.st_ino;
  return made_by_shell ? "" : "printer.toml";
}

}  // namespace vam
