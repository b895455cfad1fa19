#include "base/log.hpp"

#include <unistd.h>

#include <cstdio>

#include "base/printable.hpp"
#include "base/status_line.hpp"

namespace vam {

namespace {
std::string program = "vam";  // NOLINT: one per process
Talk settings;                // NOLINT: likewise

void put(const std::string& line) {
  status_line::make_way();
  std::fprintf(stderr, "%s\n", printable(line).c_str());
}
}  // namespace

void set_program_name(const std::string& name) { program = name; }
const std::string& program_name() { return program; }

void set_talk(const Talk& talk) { settings = talk; }
const Talk& talk() { return settings; }

void say(const std::string& line) { put(program + ": " + line); }

void warn(const std::string& line) {
  if (!settings.quiet) say("warning: " + line);
}

void note(const std::string& line) {
  if (settings.quiet) return;
  if (settings.verbose || isatty(STDERR_FILENO) == 1) put(line);
}

}  // namespace vam
