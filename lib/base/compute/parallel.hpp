// SPDX-License-Identifier: GPL-3.0-or-later
// Threads, only through here. Work items are independent and write to their own place, so results do not depend on
// the number of threads.
#pragma once

#include <functional>

namespace vam {

/// Calls work(i) for i in [0, count), in any order, on the threads set by set_threads().
/// An exception thrown by an item stops the loop and is rethrown here.
void parallel_for(int count, const std::function<void(int)>& work);

/// Limits the number of threads; 0 means all cores (the default).
void set_threads(int threads);
[[nodiscard]] int threads();

}  // namespace vam
