// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/starting_point.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "device/os/interrupt.hpp"
#include "io/settings/printer_file.hpp"
#include "io/stream/log_lines.hpp"
#include "model/coarser.hpp"
#include "vam-optimize/task.hpp"

namespace vam::optimize_tool {

namespace {

/// Which job a state is of: the printer, the options, what the files hold that the options name beside the volumes (the
/// slices have digests of their own), and how the limit is raised.
std::string job_of(const cli::App& app, const model::Printer& printer, const Options& options) {
  std::string job = io::printer_toml(printer) + app.job();
  job += "raising=" + format_number(options.raising.factor) + "\n";
  if (options.recorded_tolerances) job += model::tolerances_text(*options.printer_tolerances) + "\n";
  for (const std::string& path : {options.response, printer.projector.response}) {
    if (path != "-" && std::filesystem::is_regular_file(path)) job += io::sha256_of(path) + "\n";
  }
  return job;
}

// Before it is opened for writing, which would wait for a pipe.
const std::string& regular(const std::string& path) {
  (void)io::has_regular_file(path);
  return path;
}

}  // namespace

Initial::Initial(const std::string& path, const model::StackInfo& want) : path_(path), reader_(path) {
  const auto& is = reader_.info();
  io::require(path, is, model::Kind::sinogram, want.space);
  if (is.width == want.width && is.height == want.height && is.count == want.count) return;
  const auto size = [](const model::StackInfo& s) {
    return std::to_string(s.width) + " columns x " + std::to_string(s.height) + " angles x " + std::to_string(s.count) +
           " slices";
  };
  throw Error{Fault::data, path + ": " + size(is) + ", but the target needs " + size(want) +
                               "; use the same target, --angles and --detector-bins"};
}

Image Initial::operator()(int k) {
  constexpr int kept = 64;
  model::ImageInfo about;
  for (; next_ <= k; ++next_) {
    Image image;
    if (!reader_.next(image, about)) throw Error{Fault::data, path_ + ": ends at slice " + std::to_string(next_)};
    recent_.emplace(next_, std::move(image));
    recent_.erase(next_ - kept);
  }
  return recent_.at(k);
}

Checkpoint::Checkpoint(const std::string& path)
    : path_(regular(path)),
      out_(path),
      to_(optimize::Archive::Direction::out, path, [this](void* bytes, std::size_t size) { out_.write(bytes, size); }) {
  if (!std::filesystem::exists(path)) return;
  in_.emplace(path);
  from_.emplace(
      optimize::Archive::Direction::in, path, [this](void* bytes, std::size_t size) { take(bytes, size); },
      [this] { return in_->at_end(); });
}

void Checkpoint::take(void* bytes, std::size_t size) {
  const std::size_t got = in_->read(bytes, size);
  if (got == size) return;
  throw Error{Fault::data, path_ + ": ends after " + std::to_string(in_->position()) +
                               " bytes, which is incomplete; remove it and start again"};
}

optimize::CheckpointState Checkpoint::state(const std::string& job) {
  return {device::interrupted, &to_, from_ ? &*from_ : nullptr, job};
}

void Checkpoint::remove() const {
  if (in_) std::filesystem::remove(path_);
}

StartingPoint::StartingPoint(const cli::App& app, const model::Printer& printer, const model::StackInfo& info,
                             const Options& options)
    : count_(info.count), width_(info.width), height_(info.height) {
  if (!options.init.empty()) initial_.emplace(options.init, info);
  if (options.checkpoint.empty()) return;
  checkpoint_.emplace(options.checkpoint);
  state_ = checkpoint_->state(job_of(app, printer, options));
}

void StartingPoint::begin(optimize::VolumeTask& task, const session::JobVolumes& in, const session::Scene& scene,
                          const light::Operator& light, Options& options) {
  if (initial_) task.initial = [this](int k) { return k < count_ ? (*initial_)(k) : Image(width_, height_); };
  task.checkpoint = state_;
  if (state_.from != nullptr && light.couples_slices()) return;  // there is one pass
  if (auto start = coarse_start(in, scene, options)) continue_from(std::move(*start), task, options);
}

namespace {

constexpr int least_side = 24;        // a side of the coarser part
constexpr double most_wrong = 0.02;   // voxel error rate of a print that is of use
constexpr int first_iterations = 60;  // at the coarsest level
constexpr double most_time = 0.5;     // of --budget, for all coarser levels
constexpr int raises = 3, shortest_raises = 20;
constexpr int next_iterations = 10;  // at those above, and for each raise of the limit where the part does not print
constexpr double least_half_width = 0.05,
                 largest_half_width = 0.08;  // in doses; a wider one costs the surface its place

optimize::StackSamples samples(const session::Scene& scene, const Options& options) {
  const model::Projector& projector = scene.printer.projector;
  optimize::Samples columns{scene.turn.columns, -0.5 * (scene.turn.columns - 1) * scene.grid.voxel_mm,
                            scene.grid.voxel_mm};
  if (options.in_vial()) {
    columns = {projector.columns, -projector.axis_column * projector.pixel_mm, projector.pixel_mm};
  }
  const optimize::Samples angles{scene.frames(), 0, 360.0 / scene.frames()};
  return {columns, angles, {scene.grid.nz, scene.grid.z_mm(0), scene.grid.voxel_mm}};
}

bool worthwhile(const model::Grid& grid) { return std::min(grid.nx, grid.ny) >= 2 * least_side && grid.nz > 1; }

SolvedLevel solve_level(const session::JobVolumes& in, const session::Scene& scene, Options options,
                        std::optional<CoarseStart> before) {
  optimize::VolumeTask task = make_task(scene, in, options);
  task.title += " at " + mm_text(scene.grid.voxel_mm);
  task.limits.patience = task.limits.early = 0;
  task.limits.at_least = task.limits.iterations = before ? next_iterations : first_iterations;
  if (before) continue_from(std::move(*before), task, options);
  if (task.raising.factor > 0) {
    task.raising.first =
        task.limits.at_least + 1;  // one more: the conditions are not evaluated after the last iteration
    task.raising.next = next_iterations;
    task.limits.iterations = task.raising.first + (options.shortest ? shortest_raises : raises) * next_iterations;
  }
  task.checkpoint.pause = device::interrupted;
  return solved(task, scene, options);
}

/// What is refused at a coarser level is left to the finer one.
std::optional<CoarseStart> start_from_coarser(const session::JobVolumes& in, const session::Scene& finer,
                                              const Options& options, const Options& finer_options) {
  const session::Scene scene = session::make_scene(in.target.front(), model::coarser(finer.printer), options);
  std::optional<CoarseStart> before = coarse_start(in, scene, options);
  if (device::interrupted()) return std::nullopt;
  return start_of(solve_level(in, scene, options, std::move(before)), scene, options, finer, finer_options);
}

}  // namespace

Options coarser(const Options& options) {
  Options coarse = options;
  coarse.angles = (options.angles + 1) / 2;
  if (options.bins) coarse.bins = (*options.bins + 1) / 2;
  coarse.trace.clear();
  coarse.certify.clear();
  return coarse;
}

SolvedLevel solved(optimize::VolumeTask& task, const session::Scene& scene, const Options& options) {
  SolvedLevel level;
  task.write = [&](int, const Image& image) { level.images.push_back(image); };
  level.outcome = optimize::optimise(task, *session::make_light(scene, options));
  return level;
}

std::optional<CoarseStart> start_of(SolvedLevel level, const session::Scene& scene, const Options& options,
                                    const session::Scene& finer, const Options& finer_options) {
  const optimize::VolumeOutcome& outcome = level.outcome;
  const model::DoseMetrics& m = outcome.metrics;
  if (outcome.stop == optimize::StopReason::interrupted || m.part == 0 || m.ver > most_wrong) return std::nullopt;
  note("vam-optimize: voxels of " + mm_text(scene.grid.voxel_mm) + ": process window " + format_number(m.pw, 2) +
       ", VER " + format_number(m.ver, 2) + " after " + std::to_string(outcome.iterations) + " iterations");
  return CoarseStart{{std::move(level.images), samples(scene, options), samples(finer, finer_options)},
                     m.pw > 0 ? std::clamp(0.5 * m.pw, least_half_width, largest_half_width) : 0,
                     outcome.even,
                     outcome.eigenvalue,
                     outcome.max_intensity};
}

std::optional<CoarseStart> coarse_start(const session::JobVolumes& in, const session::Scene& scene,
                                        const Options& options) {
  if (!options.coarse_start || !worthwhile(in.grid())) return std::nullopt;
  try {
    Options coarse = coarser(options);
    if (coarse.limits.deadline) {
      coarse.limits.deadline = coarse.limits.deadline->share(most_time);
      coarse.limits.deadline->rest_iterations = 1;
    }
    return start_from_coarser(coarser(in), scene, coarse, options);
  } catch (const Error& error) {
    if (error.fault != Fault::data && error.fault != Fault::usage) throw;
    return std::nullopt;
  }
}

void continue_from(CoarseStart start, optimize::VolumeTask& task, Options& options) {
  task.initial = std::move(start.images);
  task.even = start.even;
  if (options.shortest && start.max_intensity > 0) {  // found where it costs little
    task.limit = {.most = start.max_intensity, .of_even = 0};
    task.raising.first = optimize::shortest_refinements;
  }
  options.how.half_width = start.half_width;
  options.how.eigenvalue = start.eigenvalue;
}

}  // namespace vam::optimize_tool
