// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <limits>
#include <vector>

#include "base/compute/memory.hpp"
#include "io/stream/private/sandbox.hpp"

namespace vam::io {

namespace {

constexpr std::uint64_t mib = std::uint64_t{1} << 20;

// The size of the address space, which is what RLIMIT_AS counts; 0 where there is no /proc.
std::uint64_t address_space() {
  std::ifstream facts("/proc/self/statm");
  std::uint64_t pages = 0;
  facts >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

// False where there is a lower limit already.
bool limit(int resource, rlim_t most) {
  rlimit now{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &now) != 0) return false;
  const rlimit lower{std::min(now.rlim_cur, most), now.rlim_max};
  return setrlimit(static_cast<__rlimit_resource>(resource), &lower) == 0 && lower.rlim_cur == most;
}

// Interrupts are the parent's to answer; the child dies with it.
void reset_signals() {
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE, SIGXCPU, SIGCHLD, SIGALRM}) {
    (void)std::signal(number, SIG_DFL);
  }
  for (const int number : {SIGHUP, SIGINT, SIGTERM, SIGQUIT}) (void)std::signal(number, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

void close_others(std::initializer_list<int> kept) {
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {  // what a library says is not for people
    if (std::find(kept.begin(), kept.end(), standard) == kept.end()) (void)dup2(nothing, standard);
  }
  std::vector<int> open_ones(kept);
  std::sort(open_ones.begin(), open_ones.end());
  int from = STDERR_FILENO + 1;
  for (const int descriptor : open_ones) {
    if (descriptor < from) continue;
    if (descriptor > from) (void)close_range(static_cast<unsigned>(from), static_cast<unsigned>(descriptor - 1), 0);
    from = descriptor + 1;
  }
  (void)close_range(static_cast<unsigned>(from), std::numeric_limits<unsigned>::max(), 0);
}

void filter_calls() {
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  if (filter == nullptr) return;
  for (const int call : {SCMP_SYS(read),           SCMP_SYS(write),        SCMP_SYS(readv),
                         SCMP_SYS(writev),         SCMP_SYS(lseek),        SCMP_SYS(fstat),
                         SCMP_SYS(newfstatat),     SCMP_SYS(brk),          SCMP_SYS(mmap),
                         SCMP_SYS(munmap),         SCMP_SYS(mremap),       SCMP_SYS(mprotect),
                         SCMP_SYS(madvise),        SCMP_SYS(futex),        SCMP_SYS(exit),
                         SCMP_SYS(exit_group),     SCMP_SYS(rt_sigreturn), SCMP_SYS(rt_sigaction),
                         SCMP_SYS(rt_sigprocmask), SCMP_SYS(sigaltstack),  SCMP_SYS(getpid),
                         SCMP_SYS(gettid),         SCMP_SYS(sched_yield),  SCMP_SYS(clock_gettime),
                         SCMP_SYS(getrandom),      SCMP_SYS(getrusage),    SCMP_SYS(restart_syscall),
                         SCMP_SYS(poll),           SCMP_SYS(ppoll)}) {
    (void)seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0);
  }
  // abort() sends itself a signal.
  (void)seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1,
                         SCMP_A0(SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid())));
  (void)seccomp_load(filter);  // without it in the kernel the limits hold alone
}

}  // namespace

ResourceBounds bounds_of(std::uint64_t file_bytes, std::uint64_t unpacked_bytes) {
  const std::uint64_t left = memory_left();
  if (file_bytes == 0) return {left, 600, false};
  const std::uint64_t unpacked = 64 * file_bytes + unpacked_bytes;
  const std::uint64_t wanted = 256 * mib + unpacked;
  return {std::min(wanted, left), 10 + unpacked / (64 * mib), left < wanted};
}

bool confine(const ResourceBounds& bounds, int parent, std::initializer_list<int> kept) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);
  reset_signals();
  (void)limit(RLIMIT_CORE, 0);
  (void)limit(RLIMIT_CPU, bounds.cpu_s);
  const std::uint64_t now = address_space();
  const bool ours = now > 0 && limit(RLIMIT_AS, now + bounds.memory_bytes);
  close_others(kept);
  filter_calls();
  return ours;
}

}  // namespace vam::io
