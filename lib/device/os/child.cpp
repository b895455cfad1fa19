// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/status_line.hpp"
#include "base/system_error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "device/os/interrupt.hpp"

namespace vam::device {

namespace {

constexpr std::array ended_by{SIGINT, SIGTERM, SIGHUP};
constexpr int niceness = 10;

[[noreturn]] void fail_in_child(const char* what) {
  dprintf(STDERR_FILENO, "%s: %s: %s\n", program_invocation_short_name, what, std::strerror(errno));
  _exit(127);
}

void connect(int descriptor, const char* path, int flags) {
  const int opened = open(path, flags, 0644);
  if (opened < 0) fail_in_child(path);
  if (opened == descriptor) return;
  dup2(opened, descriptor);
  close(opened);
}

// What the print does not depend on: others go first, it takes half of the memory at most, and where that ends, the
// kernel ends this one.
void give_way() {
  const auto bytes = static_cast<rlim_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
  const rlimit half{bytes / 2, bytes / 2};
  setrlimit(RLIMIT_DATA, &half);
  setpriority(PRIO_PROCESS, 0, niceness);
  const int score = open("/proc/self/oom_score_adj", O_WRONLY);
  if (score < 0) return;
  if (write(score, "1000", 4) < 0) errno = 0;  // it is as it was
  close(score);
}

// Between fork and exec: no memory is taken, as other threads may hold its locks.
[[noreturn]] void become(char* const* words, const Command& command, const char* said, const Manner& manner,
                         pid_t parent, const sigset_t& mask) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);  // also while a pipe waits for its other end
  if (getppid() != parent) _exit(128 + SIGTERM);
  for (const int signal : ended_by) (void)std::signal(signal, manner.undisturbed ? SIG_IGN : SIG_DFL);
  for (const int signal : {SIGINT, SIGQUIT}) (void)std::signal(signal, SIG_IGN);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGTSTP}) (void)std::signal(signal, SIG_DFL);
  setpgid(0, 0);  // what is typed at the terminal, and its end, is for this process alone, which orders theirs
  (void)std::signal(SIGTTOU, SIG_IGN);
  sigprocmask(SIG_SETMASK, &mask, nullptr);
  if (!manner.on_terminal) connect(STDERR_FILENO, said, O_WRONLY | O_CREAT | O_APPEND);
  connect(STDIN_FILENO, "/dev/null", O_RDONLY);
  if (!manner.on_terminal) connect(STDOUT_FILENO, "/dev/null", O_WRONLY);
  for (const Redirection& file : command.files) connect(file.descriptor, file.path.c_str(), file.flags);
  if (manner.on_terminal) dup2(STDERR_FILENO, STDOUT_FILENO);
  if (manner.shared >= 0) fcntl(manner.shared, F_SETFD, 0);
  if (manner.nice) give_way();
  if (!manner.with_parent) prctl(PR_SET_PDEATHSIG, 0);
  execvp(words[0], words);
  fail_in_child(words[0]);
}

}  // namespace

void supervise() {
  (void)std::signal(SIGCHLD, SIG_DFL);  // ignored, it would hide how the tools end
  for (const int signal : {SIGPIPE, SIGTSTP, SIGTTOU}) (void)std::signal(signal, SIG_IGN);
}

Child::Child(const Command& command, const std::string& said, const Manner& manner) : name_(command.name) {
  std::vector<char*> words;
  for (const std::string& word : command.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, &before);  // a handler of this process has nothing to say in the other
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) become(words.data(), command, said.c_str(), manner, parent, before);
  const int problem = errno;
  sigprocmask(SIG_SETMASK, &before, nullptr);
  if (pid_ < 0) {
    throw Error{Fault::memory, command.words.front() + ": cannot be started (" + std::strerror(problem) +
                                   "); raise the limit of processes or memory"};
  }
  handle_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));  // closed on exec
  if (handle_ >= 0) return;
  const std::string reason = std::strerror(errno);
  ::kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  throw Error{Fault::memory, command.words.front() + ": cannot be watched (" + reason + "); raise the limit of files"};
}

Child::Child(Child&& other) noexcept
    : name_(std::move(other.name_)), pid_(std::exchange(other.pid_, -1)), handle_(std::exchange(other.handle_, -1)) {}

Child& Child::operator=(Child&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(pid_, other.pid_);
  std::swap(handle_, other.handle_);
  return *this;
}

Child::~Child() {
  if (handle_ >= 0) close(handle_);
}

bool Child::ends_within(int limit_ms) const {
  pollfd ended{handle_, POLLIN, 0};
  return poll(&ended, 1, limit_ms) > 0;
}

int Child::status(int limit_ms) {
  if (limit_ms >= 0 && !ends_within(limit_ms)) order(SIGKILL);
  int how = 0;
  pid_t ended = 0;
  while ((ended = waitpid(pid_, &how, 0)) < 0 && errno == EINTR) continue;
  if (ended != pid_) return static_cast<int>(Fault::bug);
  return WIFSIGNALED(how) ? 128 + WTERMSIG(how) : WEXITSTATUS(how);
}

void wait_for_an_end(const std::vector<Child>& children, int limit_ms) {
  std::vector<pollfd> events{{interrupt_fd(), POLLIN, 0}};
  for (const Child& child : children) events.push_back({child.handle(), POLLIN, 0});
  while (poll(events.data(), events.size(), limit_ms) < 0 && !interrupted()) continue;
  check_interrupted();
}

int run_to_end(const Command& command, const std::string& said, int limit_ms) {
  std::vector<Child> child;
  child.emplace_back(command, said, Manner{.with_parent = true});
  const auto end = [&] { end_all(child, [](Child&, int) {}); };
  try {
    wait_for_an_end(child, limit_ms);
  } catch (const Interrupted&) {
    end();
    throw;
  }
  if (child.front().ends_within(0)) return child.front().status();
  end();
  return timed_out;
}

void end_all(std::vector<Child>& children, const std::function<void(Child&, int)>& ended) {
  using std::chrono::steady_clock;
  constexpr std::chrono::milliseconds patience{2000};
  for (const Child& child : children) child.order(SIGTERM);
  const auto until = steady_clock::now() + patience;
  for (Child& child : children) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - steady_clock::now()).count();
    ended(child, child.status(std::max(0, static_cast<int>(left))));
  }
  children.clear();
}

std::string switch_off(const Talk& talk, const std::string& printer, const std::string& light) {
  constexpr int limit_ms = 10000;
  std::string printed;
  int status = 1;
  try {
    printed = talk.path("off.out");
    const Command command{"off",
                          {"vam-devices", "off", "--printer", printer, "--light", light.empty() ? "none" : light},
                          {{STDOUT_FILENO, printed, O_WRONLY | O_CREAT | O_TRUNC}}};
    status = Child(command, talk.path("off"), {.undisturbed = true}).status(limit_ms);
  } catch (const Error& error) {
    say(error.what());
  }
  talk.show("off");
  talk.forget("off");
  std::vector<std::string> devices;
  for (const std::string& line : split(trimmed(text_of(printed), "\n"), '\n')) {
    std::vector<std::string> words = split(line, ' ');
    std::erase(words, "");
    devices.push_back(join(words, " "));
  }
  const std::string said = join(devices, ", ");
  return status == 0 ? said : "LIGHT OR MOTION MAY BE ON" + (said.empty() ? "" : ", but " + said);
}

TemporaryFolder::TemporaryFolder() {
  const char* parent = std::getenv("TMPDIR");
  path_ = std::string(parent == nullptr || *parent == '\0' ? "/tmp" : parent) + "/vam.XXXXXX";
  if (mkdtemp(path_.data()) == nullptr)
    throw system_error(Fault::no_output, path_ + ": cannot create the folder", errno);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Talk::~Talk() {
  for (const auto& file : files_) close(file.second);
}

std::string Talk::path(const std::string& tool) const {
  const auto [file, fresh] = files_.try_emplace(tool, -1);
  if (fresh) file->second = memfd_create(tool.c_str(), MFD_CLOEXEC);
  if (file->second < 0) throw system_error(Fault::memory, "cannot hold what " + tool + " says", errno);
  return "/proc/self/fd/" + std::to_string(file->second);
}

std::string Talk::text(const std::string& tool) const {
  const auto file = files_.find(tool);
  return file == files_.end() ? "" : text_of("/proc/self/fd/" + std::to_string(file->second));
}

void Talk::add(const std::string& tool, const std::string& line) const {
  std::ofstream(path(tool), std::ios::app) << line + "\n";
}

void Talk::forget(const std::string& tool) const { std::ofstream(path(tool), std::ios::trunc).close(); }

void Talk::forget() const {
  for (const auto& file : files_) forget(file.first);
}

void Talk::show(const std::string& tool, const std::function<bool(const std::string&)>& counts) const {
  const std::string said = trimmed(text(tool), "\n");
  if (said.empty()) return;
  for (const std::string& line : split(said, '\n')) {
    if (!counts || counts(line)) pass_on(line);
  }
}

void Talk::keep(const std::string& run) const {
  for (const auto& file : files_) {
    if (const std::string said = text(file.first); !said.empty())
      std::ofstream(run + "/" + file.first + ".err") << said;
  }
}

std::string text_of(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return "";
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

}  // namespace vam::device
