#include "optimize/volume.hpp"

#include <algorithm>
#include <map>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/text.hpp"
#include "optimize/schedule.hpp"
#include "optimize/slice_figures.hpp"

namespace vam::optimize {

namespace {

std::size_t pixels(Shape shape) {
  return static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.height);
}

/// Voxels that part and insert together fill more than once, rounding left aside.
long overlap(const float* part, const float* insert, std::size_t count) {
  constexpr float more_than_full = 1.05F;
  long shared = 0;
  for (std::size_t i = 0; i < count; ++i) shared += part[i] + insert[i] > more_than_full ? 1 : 0;
  return shared;
}

bool void_inside(const float* slice, Shape shape, const Circle& circle) {
  for (int y = 0; y < shape.height; ++y) {
    for (int x = 0; x < shape.width; ++x, ++slice) {
      if (*slice <= model::coverage_rounding && circle.contains(x, y)) return true;
    }
  }
  return false;
}

/// Digests of all slices; also the place where a part beyond the light is noticed.
std::vector<Digest> digests(const VolumeTask& task, Shape shape) {
  std::vector<Digest> all(static_cast<std::size_t>(task.slices));
  std::vector<double> reaches(lanes);
  std::vector<char> has_void(lanes);
  std::vector<float> inserts(task.read_insert ? pixels(shape) * lanes : 0);
  std::vector<long> overlaps(lanes, 0);
  bool any_part = false;
  bool any_void = false;
  std::vector<float> buffer(pixels(shape) * lanes);
  for (int k = 0; k < task.slices; k += lanes) {
    const int count = std::min(lanes, task.slices - k);
    task.read(k, count, buffer.data());
    if (task.read_insert) task.read_insert(k, count, inserts.data());
    parallel_for(count, [&](int i) {
      const float* slice = buffer.data() + static_cast<std::size_t>(i) * pixels(shape);
      Digest& mark = all[static_cast<std::size_t>(k + i)];
      mark = digest({slice, pixels(shape)});
      reaches[static_cast<std::size_t>(i)] =
          reach(slice, shape.width, shape.height, task.circle.axis_x, task.circle.axis_y);
      has_void[static_cast<std::size_t>(i)] = void_inside(slice, shape, task.circle) ? 1 : 0;
      if (!task.read_insert) return;
      const float* insert = inserts.data() + static_cast<std::size_t>(i) * pixels(shape);
      mark = digest({insert, pixels(shape)}, mark);
      overlaps[static_cast<std::size_t>(i)] = overlap(slice, insert, pixels(shape));
    });
    for (int i = 0; i < count; ++i) {
      any_part = any_part || reaches[static_cast<std::size_t>(i)] >= 0;
      any_void = any_void || has_void[static_cast<std::size_t>(i)] != 0;
      if (overlaps[static_cast<std::size_t>(i)] > 0) {
        throw Error{Fault::data, "slice " + std::to_string(k + i) + ": part and insert share " +
                                     std::to_string(overlaps[static_cast<std::size_t>(i)]) +
                                     " voxels; cut the insert out of the part"};
      }
      const double r = reaches[static_cast<std::size_t>(i)];
      if (r <= task.circle.radius) continue;
      throw Error{Fault::data, "slice " + std::to_string(k + i) + ": the part reaches " + format_number(r, 4) +
                                   " voxels from the axis, but light reaches only " +
                                   format_number(task.circle.radius, 4) + "; scale the part down or use a wider vial"};
    }
  }
  if (!any_part) throw Error{Fault::data, "the target is empty (no coverage anywhere); there is nothing to print"};
  if (!any_void) {
    throw Error{Fault::data, "the target fills the whole writable circle; without void there is nothing to optimise"};
  }
  return all;
}

/// One pass after the other, results kept until they have been written for the last time.
class Run {
 public:
  Run(const VolumeTask& task, const Operator& light) : task_(task), light_(light) {
    const std::size_t bytes = pixels(light.image()) * sizeof(float);
    schedule_ = make_schedule(digests(task, light.object()),
                              static_cast<int>(std::max<std::size_t>(1, task.keep_bytes / bytes)));
    times_.assign(schedule_.slice_of_job.size(), 0);
    for (const int job : schedule_.job_of_slice) ++times_[static_cast<std::size_t>(job)];
  }

  VolumeOutcome operator()() {
    const int jobs = static_cast<int>(schedule_.slice_of_job.size());
    outcome_.jobs = jobs;
    for (int first = 0; first < jobs; first += slices_per_pass) {
      pass(first, std::min(slices_per_pass, jobs - first));
      write_ready(first + slices_per_pass);
    }
    SliceFigures ended;  // passes that stopped earlier count with their last state
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      SliceFigures all = rows_[i];
      all.add(ended);
      outcome_.trace.push_back(all.mean());
      ended.add(ends_[i]);
    }
    outcome_.metrics = total_.metrics();
    outcome_.efficiency = efficiency_.value();
    return outcome_;
  }

 private:
  [[nodiscard]] Problem load(int first, int count) const {
    const Shape shape = light_.object();
    std::vector<float> slices(pixels(shape) * static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      task_.read(slice(first + i), 1, slices.data() + static_cast<std::size_t>(i) * pixels(shape));
    }
    return make_problem(slices.data(), count, shape.width, shape.height, task_.circle, task_.window);
  }

  /// The operator around the inserts of these jobs; the problem loses what the inserts fill and hide.
  std::unique_ptr<Operator> go_around(Problem& problem, int first, int count) {
    const Shape shape = light_.object();
    std::vector<Slab> inserts;
    std::vector<float> slices(pixels(shape) * lanes);
    for (int i = 0; i < count; i += lanes) {
      const int used = std::min(lanes, count - i);
      for (int lane = 0; lane < used; ++lane) {
        task_.read_insert(slice(first + i + lane), 1, slices.data() + static_cast<std::size_t>(lane) * pixels(shape));
      }
      inserts.emplace_back(shape.width, shape.height);
      tomo::pack(slices.data(), used, inserts.back());
    }
    exclude(problem, inserts);
    auto light = task_.around(inserts);
    outcome_.dark_part_voxels += exclude_dark(problem, *light);
    return light;
  }

  [[nodiscard]] std::vector<Slab> initial(int first, int count) const {
    const Shape shape = light_.image();
    std::vector<Slab> g;
    for (int i = 0; i < count; i += lanes) {
      const int used = std::min(lanes, count - i);
      std::vector<float> images;
      for (int lane = 0; lane < used; ++lane) {
        const Image image = task_.initial(slice(first + i + lane));
        images.insert(images.end(), image.values.begin(), image.values.end());
      }
      Slab packed(shape.width, shape.height);
      tomo::pack(images.data(), used, packed);
      g.emplace_back(light_.sinogram().width, light_.sinogram().height);
      light_.collapse(packed, g.back());
    }
    return g;
  }

  void pass(int first, int count) {
    Problem problem = load(first, count);
    std::unique_ptr<Operator> around;
    if (task_.read_insert) around = go_around(problem, first, count);
    const Operator& light = around ? *around : light_;
    Iterate state;
    if (task_.initial) state.g = initial(first, count);
    const auto method = task_.make();
    SliceFigures last;
    int seen = 0;
    Watch watch;
    if (task_.watch) {
      watch = [&](int iteration, const std::vector<model::DoseMetrics>& slices) {
        last = {};
        for (std::size_t s = 0; s < slices.size(); ++s)
          last.add(slices[s], times_[static_cast<std::size_t>(first) + s]);
        note(iteration, last);
        seen = iteration;
      };
    }
    const Outcome outcome = iterate(*method, problem, light, task_.limits, state, watch);
    if (task_.watch) ends_[static_cast<std::size_t>(seen)].add(last);
    if (outcome.iterations >= outcome_.iterations) {
      outcome_.iterations = outcome.iterations;
      outcome_.reason = outcome.reason;
    }
    finish(problem, state, first, count);
    if (task_.progress) task_.progress(count);
  }

  void note(int iteration, const SliceFigures& figures) {
    const auto i = static_cast<std::size_t>(iteration);
    if (rows_.size() <= i) {
      rows_.resize(i + 1);
      ends_.resize(i + 1);
    }
    rows_[i].add(figures);
  }

  /// Brings the slices to the common threshold and unpacks them.
  void finish(const Problem& problem, Iterate& state, int first, int count) {
    const PerSlice factor = to_common_threshold(metrics(state.dose, problem), problem);
    scale(state.g, factor);
    scale(state.dose, factor);
    const auto slices = statistics(state.dose, problem);
    for (std::size_t s = 0; s < slices.size(); ++s)
      total_.merge(slices[s], times_[static_cast<std::size_t>(first) + s]);
    const Shape shape = light_.image();
    Slab image(shape.width, shape.height);
    std::vector<float> images(pixels(shape) * lanes);
    for (int i = 0; i < count; i += lanes) {
      const int used = std::min(lanes, count - i);
      light_.expand(state.g[static_cast<std::size_t>(i / lanes)], image);
      tomo::unpack(image, used, images.data());
      for (int lane = 0; lane < used; ++lane) {
        Image result(shape.width, shape.height);
        std::copy_n(images.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(lane) * pixels(shape)),
                    pixels(shape), result.values.begin());
        done_.emplace(first + i + lane, std::move(result));
      }
    }
  }

  void write_ready(int jobs) {
    for (; next_ < task_.slices; ++next_) {
      const int job = schedule_.job_of_slice[static_cast<std::size_t>(next_)];
      if (job >= jobs) return;
      const auto found = done_.find(job);
      efficiency_.add(found->second.values);
      task_.write(next_, found->second);
      if (schedule_.last_slice[static_cast<std::size_t>(job)] == next_) done_.erase(found);
    }
  }

  [[nodiscard]] int slice(int job) const { return schedule_.slice_of_job[static_cast<std::size_t>(job)]; }

  const VolumeTask& task_;
  const Operator& light_;
  Schedule schedule_;
  std::vector<int> times_;  // slices that a job stands for
  std::vector<SliceFigures> rows_, ends_;
  std::map<int, Image> done_;
  int next_ = 0;
  model::DoseStatistics total_;
  model::LightEfficiency efficiency_;
  VolumeOutcome outcome_;
};

}  // namespace

VolumeOutcome optimise(const VolumeTask& task, const Operator& light) { return Run(task, light)(); }

}  // namespace vam::optimize
