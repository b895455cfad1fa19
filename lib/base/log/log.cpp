// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/log/log.hpp"

#include <unistd.h>

#include <cstdio>

#include "base/log/status_line.hpp"
#include "base/text/printable.hpp"

namespace vam {

namespace {
std::string program = "vam";  // NOLINT: one per process
LogOptions settings;          // NOLINT: likewise

// What a damaged file holds may be quoted in it; the cause and the remedy stand at the ends.
void put(const std::string& line) {
  constexpr std::size_t end = 2048;
  status_line::make_way();
  std::string shown = printable(line);
  if (shown.size() > 2 * end) shown = shown.substr(0, end) + " ... " + shown.substr(shown.size() - end);
  std::fprintf(stderr, "%s\n", shown.c_str());
}
}  // namespace

void set_program_name(const std::string& name) { program = name; }
const std::string& program_name() { return program; }

void set_talk(const LogOptions& talk) { settings = talk; }
const LogOptions& talk() { return settings; }

void say(const std::string& line) { put(program + ": " + line); }

void warn(const std::string& line) {
  if (!settings.quiet) say("warning: " + line);
}

void note(const std::string& line) {
  if (settings.quiet) return;
  if (settings.verbose || isatty(STDERR_FILENO) == 1) put(line);
}

}  // namespace vam
