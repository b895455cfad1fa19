// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/realtime.hpp"

#include <sched.h>
#include <sys/resource.h>

namespace vam::device {

void hurry(Urgency urgency) {
  const sched_param priority{static_cast<int>(urgency)};
  if (sched_setscheduler(0, SCHED_RR | SCHED_RESET_ON_FORK, &priority) != 0) setpriority(PRIO_PROCESS, 0, -10);
}

}  // namespace vam::device
