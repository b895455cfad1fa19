#include "base/parallel.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <memory>

namespace vam {

namespace {
std::unique_ptr<tbb::global_control> limit;  // NOLINT: one per process, like the thread pool it limits
}  // namespace

void parallel_for(int count, const std::function<void(int)>& work) {
  tbb::parallel_for(
      tbb::blocked_range<int>(0, count, 1),
      [&](const tbb::blocked_range<int>& range) {
        for (int i = range.begin(); i != range.end(); ++i) work(i);
      },
      tbb::simple_partitioner{});
}

void set_threads(int count) {
  limit.reset();
  if (count > 0) {
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(count));
  }
}

int threads() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace vam
