// SPDX-License-Identifier: GPL-3.0-or-later
// How often a test of many trials tries: ctest --preset long says more.
#pragma once

#include <cstdlib>

/// $VAM_TRIALS, else what is given.
inline int trials_or(int by_default) {
  const char* given = std::getenv("VAM_TRIALS");
  return given != nullptr ? std::atoi(given) : by_default;
}
