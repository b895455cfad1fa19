// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/process.hpp"

#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <cerrno>  // program_invocation_name
#include <cstring>
#include <fstream>
#include <iterator>

namespace vam::device {

void hurry(Urgency urgency) {
  const sched_param priority{static_cast<int>(urgency)};
  if (sched_setscheduler(0, SCHED_RR | SCHED_RESET_ON_FORK, &priority) != 0) setpriority(PRIO_PROCESS, 0, -10);
}

void take_time() {
  const sched_param usual{};
  (void)sched_setscheduler(0, SCHED_OTHER, &usual);
}

// The kernel reads the command line where it put it: from the program's name on, so many bytes [proc(5), cmdline].
void name_process(const std::string& name) {
  prctl(PR_SET_NAME, name.c_str());
  std::ifstream file("/proc/self/cmdline");
  const std::string line{std::istreambuf_iterator<char>(file), {}};
  char* begin = program_invocation_name;
  if (line.empty() || line.compare(0, std::strlen(begin) + 1, begin, std::strlen(begin) + 1) != 0) return;
  std::memset(begin, 0, line.size());
  name.copy(begin, line.size() - 1);
}

}  // namespace vam::device
