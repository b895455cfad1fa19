// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/compute/parallel.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace vam {

namespace {
std::unique_ptr<tbb::global_control> limit;  // NOLINT: one per process, like the thread pool it limits

// How many threads the system gives beside this one, up to `wanted`; all of them live for a moment.
int threads_to_have(int wanted) {
  std::mutex mutex;
  std::condition_variable changed;
  bool counted = false;
  std::vector<std::thread> made;
  try {
    while (count_of(made) < wanted) {
      made.emplace_back([&] {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return counted; });
      });
    }
  } catch (const std::system_error&) {  // a container's limit, for one
  } catch (const std::bad_alloc&) {     // of a limit of addresses
  }
  {
    const std::scoped_lock lock(mutex);
    counted = true;
  }
  changed.notify_all();
  for (std::thread& thread : made) thread.join();
  return count_of(made);
}

// oneTBB ends the process when it is refused a thread; so it is not to ask for one that it will not get.
void limit_tbb_to_available_threads() {
  static std::once_flag read;
  std::call_once(read, [] {
    const int wanted = threads() - 1;
    const int had = threads_to_have(wanted);
    if (had == wanted) return;
    // Never destroyed: that would ask for the others again.
    static auto* const possible = new tbb::global_control(tbb::global_control::max_allowed_parallelism, had + 1);
    (void)possible;
  });
}

// Another program may have taken a thread that was there when they were counted.
template <class Loop>
void with_threads(const Loop& loop) {
  try {
    loop();
  } catch (const std::runtime_error& problem) {
    if (!std::string_view(problem.what()).starts_with("pthread_create has failed")) throw;  // the words of oneTBB
    throw Error{Fault::memory,
                "needs more threads than the system gives; raise its limit (ulimit -u), or use --threads 1"};
  }
}

// ThreadSanitizer sees nothing of oneTBB's own synchronisation, as the library is not instrumented. It is informed that
// what was done before a loop is seen by its items, and what these did by what follows.
#ifdef __SANITIZE_THREAD__
void hand_over(char& mark) { __tsan_release(&mark); }
void take_over(char& mark) { __tsan_acquire(&mark); }
#else
void hand_over(char&) {}
void take_over(char&) {}
#endif
}  // namespace

void parallel_for(int count, const std::function<void(int)>& work) {
  limit_tbb_to_available_threads();
  char begun = 0;
  char done = 0;
  hand_over(begun);
  with_threads([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>& range) {
          take_over(begun);
          for (int i = range.begin(); i != range.end(); ++i) work(i);
          hand_over(done);
        },
        tbb::simple_partitioner{});
  });
  take_over(done);
}

void set_threads(int count) {
  limit.reset();
  if (count > 0) {
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
  }
}

int threads() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace vam
