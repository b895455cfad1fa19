// SPDX-License-Identifier: GPL-3.0-or-later
// What reading costs, whatever else the machine does.
#pragma once

#include <sys/resource.h>

/// Processor time of this process and of its children that have ended.
inline double cpu_s() {
  double sum = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    getrusage(who, &used);
    sum += static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  }
  return sum;
}
