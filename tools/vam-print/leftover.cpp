// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <exception>
#include <set>
#include <thread>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "device/os/process.hpp"
#include "vam-print/drive.hpp"

namespace vam::print_tool {

namespace {

enum class Word { none, safe, failed };

Word guardian_word(const Run& run, const Child& tool) {
  const std::string begin = "guardian: process " + std::to_string(tool.pid()) + " ";
  for (const std::string& line : split(run.talk.text(tool.name()), '\n')) {
    if (!line.starts_with(begin)) continue;
    if (line.find(" FAILED") != std::string::npos) return Word::failed;
    if (line.find(" safe") != std::string::npos) return Word::safe;
  }
  return Word::none;
}

// The last line of a log, where it is whole and says how the tool ended.
bool has_last_word(const std::string& log) {
  const std::string text = text_of(log);
  if (!text.ends_with("}\n") && !text.ends_with("}")) return false;
  const std::string event = text_at(parse_json(last_line(text)), "event");
  return event == "end" || event == "error" || event == "interrupted";
}

void watch_for_stopped(const Run& run, const std::vector<Child>& tools, pid_t parent, int parent_handle) {
  constexpr int between_ms = 500;
  std::set<pid_t> before;
  for (pollfd ended{parent_handle, POLLIN, 0}; poll(&ended, 1, between_ms) == 0;) {
    std::set<pid_t> now;
    for (const Child& tool : tools) {
      if (!is_stopped(tool, parent)) continue;
      now.insert(tool.pid());
      if (before.count(tool.pid()) == 0) continue;
      end_stopped(run, tool);
    }
    before = now;
  }
}

// vam-print was killed: its tools end by themselves, within a second.
void see_to_the_end(const Run& run, const std::vector<Child>& tools) {
  constexpr int limit_ms = 1000;
  for (const char* name : {"project", "stage"}) {
    for (const Child& tool : tools) {
      if (tool.name() != name) continue;
      (void)tool.ends_within(limit_ms);
      if (is_left_on(run, tool)) return switch_off(run, "vam-print and " + tool.name() + " were");
    }
  }
}

}  // namespace

bool is_stopped(const Child& tool, pid_t parent) {
  const std::string facts = text_of("/proc/" + std::to_string(tool.pid()) + "/stat");
  const auto behind = facts.rfind(") ");
  return behind != std::string::npos && facts.substr(behind + 2).starts_with("T " + std::to_string(parent) + " ");
}

void end_stopped(const Run& run, const Child& tool) {
  run.talk.add(tool.name(), "vam-print: " + tool.name() + " was stopped by a signal and is ended");
  tool.order(SIGKILL);
}

bool is_left_on(const Run& run, const Child& tool) {
  if (tool.name() != "stage" && tool.name() != "project") return false;
  const std::string log = run.file(tool.name() == "stage" ? "stage.jsonl" : "flips.jsonl");
  if (text_of(log).empty()) return false;  // it had no device yet
  constexpr int tries = 8;
  constexpr std::chrono::milliseconds pause{50};
  for (int i = 0; guardian_word(run, tool) == Word::none; ++i) {
    if (has_last_word(log)) return false;
    if (i == tries) return true;
    std::this_thread::sleep_for(pause);
  }
  return guardian_word(run, tool) == Word::failed;
}

void switch_off(const Run& run, const std::string& who) {
  say(who + " killed, and no guardian says that all is safe; vam-devices off: " +
      device::switch_off(run.talk, run.file("printer.toml"), run.options.light));
}

Steward::Steward(const Run& run, const std::vector<Child>& tools) {
  const pid_t parent = getpid();
  const int handle = static_cast<int>(syscall(SYS_pidfd_open, parent, 0));
  pid_ = fork();
  if (pid_ != 0) {
    if (handle >= 0) close(handle);
    if (pid_ < 0)
      throw Error{Fault::memory, "the steward of the print cannot be started; raise the limit of processes"};
    return;
  }
  setpgid(0, 0);  // as its tools: no terminal ends it
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) (void)std::signal(signal, SIG_DFL);
  if (run.lock >= 0) close(run.lock);   // it is not among those who print
  device::name_process("vam-steward");  // who kills all of the name of vam-print spares it
  try {
    watch_for_stopped(run, tools, parent, handle);
    see_to_the_end(run, tools);
  } catch (const std::exception&) {
    // It has nobody to tell.
  }
  _exit(0);
}

Steward::~Steward() {
  if (pid_ <= 0) return;
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

}  // namespace vam::print_tool
