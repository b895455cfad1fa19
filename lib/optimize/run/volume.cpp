// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/volume.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/progress.hpp"
#include "base/text.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/run/private/division.hpp"
#include "optimize/run/private/finished.hpp"
#include "optimize/run/private/ledger.hpp"
#include "optimize/run/private/light_pieces.hpp"
#include "optimize/run/private/pass.hpp"
#include "optimize/run/private/pass_light.hpp"
#include "optimize/run/private/tally.hpp"
#include "optimize/run/private/threshold.hpp"
#include "optimize/target/exclusions.hpp"
#include "optimize/target/schedule.hpp"

namespace vam::optimize {

namespace {

/// A pass while it is worked on.
struct Work {
  Iterate state;
  Search search;
  std::unique_ptr<Method> method;
  void exchange(Archive& archive) {
    archive(state.g);
    archive(state.dose);
    method->exchange(archive);
  }
};

Schedule scheduled(const VolumeTask& task, std::span<const SliceDigest> digests, light::Shape image, bool alone) {
  // Slices that share light or dose with their neighbours are not alike because they look alike.
  if (!alone) return make_schedule(digests, -1);
  const std::size_t bytes = static_cast<std::size_t>(image.width) * image.height * sizeof(float);
  return make_schedule(digests, static_cast<int>(std::max<std::size_t>(1, task.keep_bytes / bytes)));
}

/// One pass after the other.
class VolumeRun {
 public:
  VolumeRun(const VolumeTask& task, const light::Operator& light)
      : task_(task),
        light_(light),
        reader_(task.source, light.object()),
        division_(division_of(task, light)),
        asked_(task.slices.value_or(model::ImageRange{0, task.source.slices})) {
    if (asked_.from < 0 || asked_.count() < 1 || asked_.to > task.source.slices || (task.slices && division_.whole)) {
      throw Error{Fault::usage, "slices: " + model::range_text(asked_) + " of " + std::to_string(task.source.slices) +
                                    " cannot be computed apart from the others"};
    }
    const auto digests = check(task.source, light.object(), task.circle, task.demands.grey);
    mark_ = {task.interruption.job, {}, task.watch};
    for (const SliceDigest& slice : digests) {
      mark_.target = {mark_.target[0] * 31 + slice[0], mark_.target[1] * 31 + slice[1]};
    }
    schedule_ = scheduled(task, digests, light.image(), division_.halo == 0 && !division_.whole);
    if (counts_pieces() && !division_.whole) pieces_.emplace(task_, light_, reader_);
    times_.assign(schedule_.slice_of_job.size(), 0);
    for (int k = asked_.from; k < asked_.to; ++k) ++times_[schedule_.job_of_slice[k]];
    needed_.assign(times_.size(), false);
    for (int first = 0; first < jobs();) {
      const Pass pass = division_.from(first, jobs());
      const auto own = std::span(times_).subspan(first, pass.last - first);
      if (std::any_of(own.begin(), own.end(), [](int times) { return times > 0; })) {
        std::fill(needed_.begin() + first, needed_.begin() + pass.last, true);
      }
      first = pass.last;
    }
  }

  VolumeOutcome operator()() {
    Work work;
    if (task_.interruption.to != nullptr) exchange(*task_.interruption.to, mark_);
    if (task_.interruption.from != nullptr) {
      resume(*task_.interruption.from, work);
    } else {
      fix_max_intensity();
      first_limit_ = outcome_.max_intensity;
    }
    while (skip_others([this] { ledger_.skip(); })) {
      if (!run_pass(division_.from(finished_.jobs(), jobs()), work)) return interrupted();
      work = {};
    }
    ledger_.complete(outcome_, task_.demands.grey, schedule_.job_of_slice);
    if (pieces_) outcome_.pieces = pieces_->found();
    for (std::size_t k = 0; k < outcome_.asked.size(); ++k) {
      outcome_.asked[k].peak = static_cast<double>(finished_.peaks()[k]);
    }
    outcome_.jobs = static_cast<int>(std::count_if(times_.begin(), times_.end(), [](int times) { return times > 0; }));
    outcome_.efficiency = finished_.efficiency();
    outcome_.peak_intensity = finished_.peak();
    if (outcome_.even.mean > 0) outcome_.even_intensity = task_.demands.window.threshold() / outcome_.even.mean;
    return std::move(outcome_);
  }

 private:
  [[nodiscard]] bool counts_pieces() const { return task_.count_pieces && !task_.demands.grey && !task_.slices; }
  [[nodiscard]] int jobs() const { return count_of(schedule_.slice_of_job); }
  [[nodiscard]] int slice(int job) const { return schedule_.slice_of_job[job]; }

  /// Past the jobs of passes without a slice that is asked for; false where none is left.
  template <class Each>
  bool skip_others(const Each& each) {
    for (; finished_.jobs() < jobs() && !needed_[finished_.jobs()]; finished_.skip()) each();
    return finished_.jobs() < jobs();
  }

  static VolumeOutcome interrupted() {
    VolumeOutcome outcome;
    outcome.stop = StopReason::interrupted;
    return outcome;
  }

  void fix_max_intensity() {
    const IntensityLimit& limit = task_.limit;
    if (limit.most <= 0 && limit.of_even <= 0) return;
    outcome_.even = task_.even.mean > 0
                        ? task_.even
                        : even_dose(light_, task_.circle, division_.whole ? task_.source.slices : lanes);
    if (!(outcome_.even.mean > 0)) return;  // dark: nothing to limit
    const double threshold = task_.demands.window.threshold();
    outcome_.max_intensity = limit.most > 0 ? limit.most : limit.of_even * threshold / outcome_.even.mean;
    const double least = threshold / outcome_.even.largest;
    if (task_.raising.factor > 0) outcome_.max_intensity = std::max(outcome_.max_intensity, least);
    const double reached = outcome_.max_intensity * outcome_.even.largest;
    // Light for the rest of a dose may be any that is left.
    if (task_.demands.grey || task_.source.delivered || outcome_.max_intensity >= least) return;
    throw Error{Fault::usage, "a maximum intensity of " + format_number(outcome_.max_intensity, 3) +
                                  " gives a dose of at most " + format_number(reached, 3) +
                                  " if every pixel is lit at every angle, and the threshold is " +
                                  format_number(threshold) + "; more than " + format_number(least, 3) + " is needed"};
  }

  /// False when the pass was interrupted.
  bool run_pass(const Pass& pass, Work& work) {
    PassInput input = read_pass(
        pass, [&](int job) { return slice(job); }, reader_, light_.object(), task_.circle, task_.demands,
        light_.couples_slices() || task_.blur_px > 0);
    std::unique_ptr<light::Operator> around;
    if (!input.inserts.empty()) around = with_inserts(input.problem, pass, input.inserts, work);
    const PassLight light(light_, std::move(around), task_.blur_px, pass.slices());
    std::optional<Scenarios> scenarios;
    if (task_.scenarios) scenarios.emplace(light.sharp(), task_.scenarios(input.inserts), pass.slices());
    if (!work.method) begin(work, pass, light.sharp());
    const Scenarios* faced = scenarios ? &*scenarios : nullptr;
    if (faced != nullptr) work.method->face(*faced);
    const Watch watch = [&](int iteration, const std::vector<model::DoseMetrics>& slices) {
      note(pass, iteration, slices);
    };
    AtLimit at_limit;
    if (task_.front) {
      at_limit = [&](double most) {
        outcome_.front.push_back(front_point(input.problem, light.blurred(), most, work.state, faced, task_.front));
      };
    }
    Limits limits = limits_of(pass);
    limits.watch_last = task_.watch;
    const Outcome outcome = run_shortest(*work.method, input.problem, light.blurred(), limits, task_.raising,
                                         work.state, work.search, watch, task_.interruption.pause, at_limit);
    if (outcome.stop == StopReason::interrupted) {
      if (task_.interruption.to != nullptr) keep(*task_.interruption.to, work);
      return false;
    }
    double most = work.search.max_intensity;
    if (outcome.stop != StopReason::goal &&
        return_to_best(input.problem, light.blurred(), work.search.standing, work.state)) {
      most = work.search.best_max_intensity;
    }
    work.search.standing.best_light = {};
    ledger_.end(outcome);
    outcome_.eigenvalue = work.method->eigenvalue();
    outcome_.least_ratio = std::max(outcome_.least_ratio, work.method->provable_ratio());
    outcome_.max_intensity = std::max(outcome_.max_intensity, most);  // the brightest pass sets the duration
    if (task_.certify > 0) outcome_.certificate = certify(input.problem, light.blurred(), work.state.g, task_.certify);
    finish(input.problem, work, pass, light.sharp(), most, faced);
    return true;
  }

  /// The pass has its share of the time that is left.
  [[nodiscard]] Limits limits_of(const Pass& pass) const {
    Limits limits = task_.limits;
    if (!limits.deadline) return limits;
    const double now_s = limits.deadline->now_s();
    const double share = static_cast<double>(pass.last - pass.first) / (jobs() - pass.first);
    limits.deadline->end_s = now_s + share * std::max(0.0, limits.deadline->end_s - now_s);
    return limits;
  }

  void begin(Work& work, const Pass& pass, const light::Operator& light) {
    work.search.max_intensity = first_limit_;
    work.method = task_.make(first_limit_);
    if (!task_.initial) return;
    work.state.g = collapse_images(
        pass, [&](int job) { return task_.initial(slice(job)); }, light);
  }

  /// The operator around these inserts; the problem loses what the inserts fill and hide.
  std::unique_ptr<light::Operator> with_inserts(Problem& problem, const Pass& pass, std::span<const Slab> inserts,
                                                const Work& work) {
    exclude(problem, inserts);
    auto light = task_.around(inserts);
    const auto dark = exclude_dark(problem, *light);
    for (int job = pass.first; job < pass.last && !work.method; ++job) {  // once, also when interrupted
      ledger_.add_dark(dark[job - pass.low] * times_[job]);
    }
    return light;
  }

  void note(const Pass& pass, int iteration, const std::vector<model::DoseMetrics>& slices) {
    SliceFigures figures;
    for (int job = pass.first; job < pass.last; ++job) {
      figures.add(slices[job - pass.low], times_[job]);
    }
    show(pass, iteration, figures.mean());
    if (task_.watch) ledger_.note(iteration, figures);
  }

  /// Progress in iterations of a job. A goal may be met before the last of them, but not before the first that counts.
  void show(const Pass& pass, int iteration, const model::DoseMetrics& figures) {
    const Limits& limits = task_.limits;
    int expected = limits.iterations;
    if (!limits.until.empty() && limits.at_least > 0) expected = std::min(expected, limits.at_least);
    while (expected < iteration) expected *= 2;
    const int most = std::max(1, std::min(expected, limits.iterations));
    const long before = std::count(needed_.begin(), needed_.begin() + pass.first, true);
    const long all = std::count(needed_.begin(), needed_.end(), true);
    progress_.stand(before * most + static_cast<long>(pass.last - pass.first) * iteration, all * most,
                    {{"iteration", static_cast<double>(iteration)}, {"VER", figures.ver}, {"PW", figures.pw}});
  }

  /// Takes the finished slices out of the pass, whose intensity is at most `most`.
  void finish(const Problem& problem, Work& work, const Pass& pass, const light::Operator& light, double most,
              const Scenarios* scenarios) {
    Iterate& state = work.state;
    const bool whole = division_.whole;
    // Slices that share dose with other passes are to scale already, as is what is missing of a dose.
    if (division_.halo == 0 && problem.delivered.empty()) {
      bring_to_threshold(problem, light, whole ? Together::pass : Together::slice, most, scenarios, state);
    }
    if (whole) outcome_.surface = work.method->surface_miss(state.dose);
    tally(state.dose, problem, pass, {task_.part, schedule_.job_of_slice, asked_, times_}, ledger_);
    if (light_.couples_slices() && !task_.demands.grey) outcome_.wrong = wrong_voxels(state.dose, problem);  // one pass
    if (whole && counts_pieces()) outcome_.pieces = print_pieces(state.dose, problem, task_.source);
    work.method.reset();  // images take its memory
    hand_out(state, pass, light);
  }

  /// Slab by slab: images are several times as large as the light in them.
  void hand_out(Iterate& state, const Pass& pass, const light::Operator& light) {
    state.dose.clear();
    for (std::size_t s = 0; s < state.g.size(); ++s) {
      std::vector<Image> images = expand_slab(pass, s, state.g[s], light);
      state.g[s] = {};
      if (images.empty()) continue;
      if (task_.interruption.to != nullptr) keep_finished(*task_.interruption.to, images);
      finished_.take(std::move(images));
    }
  }

  void keep(Archive& to, Work& work) {
    begin_open(to);
    exchange_open(to, work);
  }

  /// Finished passes are handed on as if they had just been computed; the open one is taken up.
  void resume(Archive& from, Work& work) {
    exchange(from, mark_);
    const auto skip = [this] { skip_others([] {}); };
    for (skip(); auto images = next_finished(from, light_.image(), jobs() - finished_.jobs()); skip()) {
      if (task_.interruption.to != nullptr) keep_finished(*task_.interruption.to, *images);
      finished_.take(std::move(*images));
    }
    exchange_open(from, work);
    from.end();
  }

  /// The pass that is open, and what the ended ones left behind.
  void exchange_open(Archive& archive, Work& work) {
    ledger_.exchange(archive);
    archive(outcome_.even.mean);
    archive(outcome_.even.largest);
    archive(first_limit_);
    archive(outcome_.max_intensity);
    archive(outcome_.least_ratio);
    exchange(archive, outcome_.front);
    work.search.exchange(archive);
    if (!work.method) work.method = task_.make(work.search.max_intensity);
    work.exchange(archive);
    archive.seal();
  }

  const VolumeTask& task_;
  const light::Operator& light_;
  SliceReader reader_;
  Division division_;
  model::ImageRange asked_;  // slices
  RunMark mark_;
  Schedule schedule_;
  std::vector<int> times_;    // slices asked for that a job stands for
  std::vector<bool> needed_;  // is a job in a pass with one of them?
  double first_limit_ = 0;    // of the intensity
  Ledger ledger_;
  VolumeOutcome outcome_;              // filled in pass by pass; the ledger has what is of all of them
  std::optional<LightPieces> pieces_;  // of slices that are optimised apart
  Finished finished_{schedule_, asked_, [this](int k, const Image& image) {
                       if (pieces_) pieces_->add(schedule_.job_of_slice[k], image);
                       task_.write(k, image);
                     }};
  Progress progress_{task_.title, 0};
};

}  // namespace

VolumeOutcome optimise(const VolumeTask& task, const light::Operator& light) {
  if (task.blur_px > 0 && !light.couples_slices() && !task.make(0)->keeps_scale()) {
    const auto able = method_names([](const MethodEntry& entry) { return entry.make({})->keeps_scale(); });
    throw Error{Fault::usage,
                "this method scales each slice separately and cannot compensate a blur between slices; use " +
                    join(able, ", ") + ", or neglect the blur"};
  }
  return VolumeRun(task, light)();
}

}  // namespace vam::optimize
