#include "vam-optimize/countdown.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include "base/log.hpp"

namespace vam::optimize_tool {

namespace {

class Countdown {
 public:
  explicit Countdown(double seconds) : seconds_(seconds), progress_("optimising", steps) {}

  double now_s() {
    const double now_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    const auto at = static_cast<long>(steps * std::min(1.0, now_s / seconds_));
    if (at > shown_) progress_.tick(at - shown_);
    shown_ = std::max(shown_, at);
    return now_s;
  }

 private:
  static constexpr long steps = 1000;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  double seconds_;
  Progress progress_;
  long shown_ = 0;
};

/// What follows the last iteration, in iterations: scaling, counting and writing; judging the frames as they are shown
/// and on other printers; the proof.
double rest_iterations(const Options& options) {
  double rest = 3;
  if (options.bits) rest += 3;
  if (!options.robust.empty()) rest += 5 + options.yield_printers / 3.0;
  if (!options.certify.empty()) rest += 1.2 * optimize::certify_iterations;
  return rest;
}

}  // namespace

optimize::Deadline deadline_of(const Options& options) {
  const auto clock = std::make_shared<Countdown>(*options.budget_s);
  return {[clock] { return clock->now_s(); }, *options.budget_s, rest_iterations(options)};
}

optimize::Deadline share_of(optimize::Deadline deadline, double share) {
  const double now_s = deadline.now_s();
  deadline.end_s = now_s + share * std::max(0.0, deadline.end_s - now_s);
  deadline.rest_iterations = 1;
  return deadline;
}

}  // namespace vam::optimize_tool
