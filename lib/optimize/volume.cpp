#include "optimize/volume.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "base/error.hpp"
#include "optimize/blurred_operator.hpp"
#include "optimize/ledger.hpp"
#include "optimize/schedule.hpp"

namespace vam::optimize {

namespace {

std::size_t pixels(Shape shape) {
  return static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.height);
}

/// The jobs of a pass: [first, last) are its own, [low, high) it knows, because they share dose with its own.
struct Pass {
  int first, last, low, high;
  [[nodiscard]] int slices() const { return high - low; }
};

/// A pass while it is worked on.
struct Work {
  Iterate state;
  Course course;
  std::unique_ptr<Method> method;
  void exchange(Archive& archive) {
    archive(course.iteration);
    archive(course.best);
    archive(course.best_at);
    archive(state.g);
    archive(state.dose);
    method->exchange(archive);
  }
};

enum class Record { finished = 1, open = 2 };

/// One pass after the other, results kept until they have been written for the last time.
class Run {
 public:
  Run(const VolumeTask& task, const Operator& light)
      : task_(task),
        light_(light),
        reader_(task.source, light.object()),
        halo_(task.blur_px > 0 ? halo_slices(task.blur_px) : 0) {
    const std::size_t bytes = pixels(light.image()) * sizeof(float);
    auto digests = check(task.source, light.object(), task.circle, task.demands.grey);
    for (const Digest& slice : digests) all_ = {all_[0] * 31 + slice[0], all_[1] * 31 + slice[1]};
    // Slices that share dose with their neighbours are not alike because they look alike.
    const int keep = halo_ > 0 ? -1 : static_cast<int>(std::max<std::size_t>(1, task.keep_bytes / bytes));
    schedule_ = make_schedule(digests, keep);
    times_.assign(schedule_.slice_of_job.size(), 0);
    for (const int job : schedule_.job_of_slice) ++times_[static_cast<std::size_t>(job)];
  }

  VolumeOutcome operator()() {
    Work work;
    if (task_.interruption.to != nullptr) head(*task_.interruption.to);
    if (task_.interruption.from != nullptr) go_on(work);
    while (next_job_ < jobs()) {
      const Pass pass = next_pass();
      if (!optimise(pass, work)) return broken_off();
      next_job_ = pass.last;
      write_ready();
      work = {};
    }
    VolumeOutcome outcome = ledger_.outcome(task_.demands.grey);
    outcome.jobs = jobs();
    outcome.efficiency = efficiency_.value();
    return outcome;
  }

 private:
  [[nodiscard]] int jobs() const { return static_cast<int>(schedule_.slice_of_job.size()); }
  [[nodiscard]] int slice(int job) const { return schedule_.slice_of_job[static_cast<std::size_t>(job)]; }

  static VolumeOutcome broken_off() {
    VolumeOutcome outcome;
    outcome.reason = "interrupted";
    return outcome;
  }

  [[nodiscard]] Pass next_pass() const {
    const int last = std::min(jobs(), next_job_ + slices_per_pass - 2 * halo_);
    return {next_job_, last, std::max(0, next_job_ - halo_), std::min(jobs(), last + halo_)};
  }

  /// False when the pass was broken off.
  bool optimise(const Pass& pass, Work& work) {
    std::vector<Slab> inserts;
    Problem problem = load(pass, inserts);
    const Operator* light = &light_;
    std::unique_ptr<Operator> around;
    if (!inserts.empty()) light = (around = go_around(problem, pass, inserts, work)).get();
    const Operator& sharp = *light;  // whose rows are the iterate's: fewer than the image's where half a turn is enough
    std::unique_ptr<Operator> blurred;
    if (halo_ > 0) light = (blurred = std::make_unique<BlurredOperator>(*light, task_.blur_px, pass.slices())).get();
    if (!work.method) {
      work.method = task_.make();
      if (task_.initial) work.state.g = initial(pass, sharp);
    }
    Watch watch;
    if (task_.watch) {
      watch = [&](int iteration, const std::vector<model::DoseMetrics>& slices) { note(pass, iteration, slices); };
    }
    const Outcome outcome =
        iterate(*work.method, problem, *light, task_.limits, work.state, work.course, watch, task_.interruption.pause);
    if (outcome.reason == "interrupted") {
      if (task_.interruption.to != nullptr) keep(*task_.interruption.to, work);
      return false;
    }
    ledger_.end(outcome);
    finish(problem, work.state, pass, sharp);
    return true;
  }

  [[nodiscard]] Problem load(const Pass& pass, std::vector<Slab>& inserts) const {
    const Shape shape = light_.object();
    check(task_.demands);
    Problem problem{.slices = 0, .target = {}, .labels = {}, .demands = task_.demands, .weight = {}, .tolerance = {}};
    for (int first = pass.low; first < pass.high; first += lanes) {
      const int used = std::min(lanes, pass.high - first);
      SliceData all;
      for (int job = first; job < first + used; ++job) {
        const SliceData one = reader_.read(slice(job));
        for (auto field : {&SliceData::target, &SliceData::insert, &SliceData::weight, &SliceData::tolerance}) {
          (all.*field).insert((all.*field).end(), (one.*field).begin(), (one.*field).end());
        }
      }
      const auto values = [](const std::vector<float>& v) { return v.empty() ? nullptr : v.data(); };
      append(problem, {values(all.target), values(all.weight), values(all.tolerance)}, used, shape.width, shape.height,
             task_.circle);
      if (all.insert.empty()) continue;
      inserts.emplace_back(shape.width, shape.height);
      tomo::pack(all.insert.data(), used, inserts.back());
    }
    return problem;
  }

  /// The operator around these inserts; the problem loses what the inserts fill and hide.
  std::unique_ptr<Operator> go_around(Problem& problem, const Pass& pass, std::span<const Slab> inserts,
                                      const Work& work) {
    exclude(problem, inserts);
    auto light = task_.around(inserts);
    const auto dark = exclude_dark(problem, *light);
    for (int job = pass.first; job < pass.last && !work.method; ++job) {  // once, also when broken off
      ledger_.add_dark(dark[static_cast<std::size_t>(job - pass.low)] * times_[static_cast<std::size_t>(job)]);
    }
    return light;
  }

  [[nodiscard]] std::vector<Slab> initial(const Pass& pass, const Operator& light) const {
    const Shape shape = light.image();
    std::vector<Slab> g;
    for (int first = pass.low; first < pass.high; first += lanes) {
      const int used = std::min(lanes, pass.high - first);
      std::vector<float> images;
      for (int job = first; job < first + used; ++job) {
        const Image image = task_.initial(slice(job));
        images.insert(images.end(), image.values.begin(), image.values.end());
      }
      Slab packed(shape.width, shape.height);
      tomo::pack(images.data(), used, packed);
      g.emplace_back(light.sinogram().width, light.sinogram().height);
      light.collapse(packed, g.back());
    }
    return g;
  }

  void note(const Pass& pass, int iteration, const std::vector<model::DoseMetrics>& slices) {
    SliceFigures figures;
    for (int job = pass.first; job < pass.last; ++job) {
      figures.add(slices[static_cast<std::size_t>(job - pass.low)], times_[static_cast<std::size_t>(job)]);
    }
    ledger_.note(iteration, figures);
  }

  /// Brings the slices to the common threshold, but never beyond the largest light.
  void bring_to_threshold(const Problem& problem, Iterate& state, const Operator& light) const {
    if (halo_ > 0) return;  // slices that share dose are to scale already
    PerSlice factor = to_common_threshold(metrics(state.dose, problem), problem);
    if (task_.max_light > 0) {
      const PerSlice brightest = largest(state.g);
      const auto most = static_cast<float>(task_.max_light * light.row_angle_rad());
      for (std::size_t s = 0; s < factor.size(); ++s) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          if (brightest[s][lane] > 0) factor[s][lane] = std::min(factor[s][lane], most / brightest[s][lane]);
        }
      }
    }
    scale(state.g, factor);
    scale(state.dose, factor);
  }

  /// Takes the finished slices out of the pass.
  void finish(const Problem& problem, Iterate& state, const Pass& pass, const Operator& light) {
    bring_to_threshold(problem, state, light);
    const auto doses = statistics(state.dose, problem);
    const auto figures = metrics(state.dose, problem);
    const Shape shape = light.image();
    std::vector<Image> images;
    Slab image(shape.width, shape.height);
    std::vector<float> values(pixels(shape) * lanes);
    for (int i = 0; i < pass.slices(); ++i) {
      const int lane = i % lanes;
      if (lane == 0) {
        light.expand(state.g[static_cast<std::size_t>(i / lanes)], image);
        tomo::unpack(image, std::min(lanes, pass.slices() - i), values.data());
      }
      const int job = pass.low + i;
      if (job < pass.first || job >= pass.last) continue;
      ledger_.add(doses[static_cast<std::size_t>(i)], figures[static_cast<std::size_t>(i)],
                  times_[static_cast<std::size_t>(job)]);
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(lane) * pixels(shape));
      images.emplace_back(shape.width, shape.height);
      std::copy_n(from, pixels(shape), images.back().values.begin());
    }
    take(std::move(images));
  }

  /// Images of the jobs that follow those already taken.
  void take(std::vector<Image> images) {
    if (task_.interruption.to != nullptr) {
      Archive& to = *task_.interruption.to;
      auto tag = static_cast<int>(Record::finished);
      auto count = static_cast<int>(images.size());
      to(tag);
      to(count);
      for (Image& image : images) to(image.values);
    }
    int job = next_job_;
    for (Image& image : images) done_.emplace(job++, std::move(image));
  }

  void write_ready() {
    for (; next_ < task_.source.slices; ++next_) {
      const int job = schedule_.job_of_slice[static_cast<std::size_t>(next_)];
      if (job >= next_job_) return;
      const auto found = done_.find(job);
      efficiency_.add(found->second.values);
      task_.write(next_, found->second);
      if (schedule_.last_slice[static_cast<std::size_t>(job)] == next_) done_.erase(found);
    }
  }

  /// Which run the state is of.
  void head(Archive& archive) {
    const std::string job = task_.interruption.job;
    std::string given = job;
    Digest target = all_;
    int watched = task_.watch ? 1 : 0;
    constexpr int magic = 0x564D4F31;
    int mark = magic;
    archive(mark);
    if (mark != magic) throw Error{Fault::data, archive.name() + ": is not a state that vam-optimize kept"};
    archive(given);
    archive(target);
    archive(watched);
    if (archive.reading() && (given != job || target != all_ || (watched != 0) != task_.watch)) {
      throw Error{Fault::data, archive.name() +
                                   ": is the state of another job; remove it, or give the same target and "
                                   "options as then"};
    }
  }

  void keep(Archive& to, Work& work) {
    auto tag = static_cast<int>(Record::open);
    to(tag);
    ledger_.exchange(to);
    work.exchange(to);
    to.seal();
  }

  /// Finished passes are handed on as if they had just been computed; the open one is taken up.
  void go_on(Work& work) {
    Archive& from = *task_.interruption.from;
    head(from);
    for (;;) {
      int tag = 0;
      from(tag);
      if (tag == static_cast<int>(Record::open)) break;
      int count = 0;
      from(count);
      if (tag != static_cast<int>(Record::finished) || count < 1 || count > jobs() - next_job_) {
        throw Error{Fault::data, from.name() + ": damaged; remove it and start afresh"};
      }
      std::vector<Image> images(static_cast<std::size_t>(count), Image(light_.image().width, light_.image().height));
      for (Image& image : images) {
        from(image.values);
        if (image.values.size() != pixels(light_.image())) {
          throw Error{Fault::data, from.name() + ": damaged; remove it and start afresh"};
        }
      }
      take(std::move(images));
      next_job_ += count;
      write_ready();
    }
    ledger_.exchange(from);
    work.method = task_.make();
    work.exchange(from);
    from.seal();
  }

  const VolumeTask& task_;
  const Operator& light_;
  SliceReader reader_;
  int halo_;
  Digest all_{};
  Schedule schedule_;
  std::vector<int> times_;  // slices that a job stands for
  Ledger ledger_;
  std::map<int, Image> done_;
  int next_job_ = 0;
  int next_ = 0;
  model::LightEfficiency efficiency_;
};

}  // namespace

VolumeOutcome optimise(const VolumeTask& task, const Operator& light) {
  if (task.blur_px > 0 && !task.make()->keeps_scale()) {
    throw Error{
        Fault::usage,
        "this method scales each slice by itself and cannot make up for a blur from slice to slice; use apg, cal, "
        "pm or bclp, or leave the blur out (--no-blur)"};
  }
  return Run(task, light)();
}

}  // namespace vam::optimize
