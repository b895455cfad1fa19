// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-print/talk.hpp"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/error.hpp"
#include "base/log/status_line.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"

namespace vam::print_tool {

namespace {

namespace fs = std::filesystem;

constexpr const char* memory = "/dev/shm";
constexpr const char* stem = "vam-print.";

// Names say whose they are: vam-print.PID.XXXXXX.
void sweep() {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(memory, ignored)) {
    const auto parts = split(entry.path().filename().string(), '.');
    const auto pid = parts.size() == 3 && parts.front() == "vam-print" ? parse_number(parts[1]) : std::nullopt;
    if (!pid || (kill(static_cast<pid_t>(*pid), 0) == 0 || errno == EPERM)) continue;
    fs::remove_all(entry.path(), ignored);  // of another user: stays
  }
}

std::string made_in(const std::string& folder) {
  std::string name = folder + "/" + stem + std::to_string(getpid()) + ".XXXXXX";
  return mkdtemp(name.data()) == nullptr ? "" : name;
}

}  // namespace

Talk::Talk() {
  sweep();
  const char* given = getenv("TMPDIR");
  const std::string other = given == nullptr ? "/tmp" : given;
  for (const std::string& folder : {std::string(memory), other}) {
    if (folder_ = made_in(folder); !folder_.empty()) return;
  }
  throw Error{Fault::no_output, other + ": cannot create a folder"};
}

Talk::~Talk() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::string Talk::path(const std::string& tool) const { return folder_ + "/" + tool + ".err"; }

std::string Talk::text(const std::string& tool) const { return text_of(path(tool)); }

void Talk::add(const std::string& tool, const std::string& line) const {
  std::ofstream(path(tool), std::ios::app) << line + "\n";
}

void Talk::forget(const std::string& tool) const {
  std::error_code ignored;
  fs::remove(path(tool), ignored);
}

void Talk::forget() const {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_, ignored)) fs::remove(entry.path(), ignored);
}

void Talk::show(const std::string& tool) const {
  show(tool, [](const std::string&) { return true; });
}

void Talk::show(const std::string& tool, const std::function<bool(const std::string&)>& counts) const {
  const std::string said = trimmed(text(tool), "\n");
  if (said.empty()) return;
  for (const std::string& line : split(said, '\n')) {
    if (counts(line)) pass_on(line);
  }
}

void Talk::keep(const std::string& run) const {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
    if (entry.path().extension() != ".err" || entry.file_size(ignored) == 0) continue;
    fs::copy_file(entry.path(), fs::path(run) / entry.path().filename(), ignored);
  }
}

std::string text_of(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return "";
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string last_line(const std::string& text) {
  const std::string whole = trimmed(text, "\n");
  return whole.substr(whole.rfind('\n') + 1);  // npos + 1: all
}

void pass_on(const std::string& line) {
  status_line::make_way();
  std::fprintf(stderr, "%s\n", printable(line).c_str());
}

}  // namespace vam::print_tool
