// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/yield.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "base/log/progress.hpp"
#include "base/text/json.hpp"
#include "light/operators/make_operator.hpp"
#include "model/dose/dose_spread.hpp"
#include "model/magnification.hpp"
#include "optimize/run/private/shown_pass.hpp"
#include "optimize/target/exclusions.hpp"

namespace vam::optimize {

namespace {

constexpr std::uint64_t seed = 13;

/// The voxels to be judged and the inserts in the light's way.
class Bench {
 public:
  Bench(const Trial& trial, const VolumeTask& task, std::span<const Image> frames)
      : trial_(trial), frames_(frames), input_(read(trial, task)) {
    if (!input_.inserts.empty()) exclude(input_.problem, input_.inserts);
  }

  [[nodiscard]] Printed print(const model::PrinterDeviation& by) const {
    const model::DeviatingPrinter off = model::deviate(trial_.printer, trial_.tolerances, by);
    light::VialSetup setup = trial_.setup(off.printer);
    setup.angle_offset_rad += off.angle_offset_rad;
    setup.z_scale = model::vertical_magnification(trial_.printer);  // of which the part was sliced
    const auto clear = light::make_operator(setup, input_.inserts);
    const double blur_mm = trial_.blur ? model::spread_mm(off.printer.resin, trial_.seconds) : 0;
    const PassLight light(*clear, nullptr, blur_mm / trial_.grid.voxel_mm, trial_.grid.nz);
    const Frames frames(frames_, clear->image());
    return judged(dose_of(all(), light, [&](int k) { return frames[k]; }), off.intensity);
  }

 private:
  [[nodiscard]] Pass all() const { return {0, trial_.grid.nz, 0, trial_.grid.nz}; }
  [[nodiscard]] PassInput read(const Trial& trial, const VolumeTask& task) const {
    const SliceReader reader(task.source, {trial.grid.nx, trial.grid.ny});
    return read_pass(
        all(), [](int k) { return k; }, reader, {trial.grid.nx, trial.grid.ny}, task.circle, task.demands, true);
  }

  [[nodiscard]] Printed judged(const std::vector<Slab>& dose, double intensity) const {
    const auto unit = static_cast<float>(intensity / trial_.threshold);
    std::vector<model::DoseStatistics> slices;
    for (int k = 0; k < trial_.grid.nz; ++k) slices.emplace_back(1.0);
    parallel_for(trial_.grid.nz, [&](int k) {
      const std::vector<Label>& labels = input_.problem.labels[k / lanes];
      const auto& values = dose[k / lanes].values;
      for (std::size_t i = k % lanes; i < values.size(); i += lanes) slices[k].add(unit * values[i], labels[i]);
    });
    model::DoseStatistics all(1.0);
    for (const model::DoseStatistics& slice : slices) all.merge(slice);
    return {all.metrics(false), all.at_threshold()->wrong};
  }

  const Trial& trial_;
  std::span<const Image> frames_;
  PassInput input_;
};

double least_margin(const Trials::Single& single) { return std::min(single.minus.margin(), single.plus.margin()); }

}  // namespace

double Printed::margin() const { return std::min(figures.min_part - 1, 1 - figures.max_void); }

Printed print_as_set(const Trial& trial, const VolumeTask& task, std::span<const Image> frames) {
  return Bench(trial, task, frames).print({});
}

Trials run_trials(const Trial& trial, const VolumeTask& task, std::span<const Image> frames) {
  const Bench bench(trial, task, frames);
  Progress progress("judging", trial.printers);
  Trials trials;
  trials.nominal = bench.print({});
  for (std::size_t i = 0; i < trial.tolerances.size(); ++i) {
    if (trial.tolerances[i] == 0) continue;
    model::PrinterDeviation plus{}, minus{};
    plus[i] = 1;
    minus[i] = -1;
    trials.singles.push_back({i, bench.print(minus), bench.print(plus)});
  }
  const auto costlier = [](const auto& a, const auto& b) { return least_margin(a) < least_margin(b); };
  trials.costliest = std::min_element(trials.singles.begin(), trials.singles.end(), costlier)->tolerance;
  for (; trials.printers < trial.printers; ++trials.printers) {
    if (bench.print(model::drawn_deviation(seed, trials.printers)).wrong <= allowed_wrong) ++trials.good;
    progress.tick();
  }
  return trials;
}

namespace {

Json figures_of(const Printed& printed) {
  const model::DoseMetrics& m = printed.figures;
  return {{"ver", m.ver},
          {"pw_of_threshold", m.pw},
          {"iou", m.iou},
          {"wrong", printed.wrong},
          {"margin_of_threshold", printed.margin()}};
}

}  // namespace

Json report(const Trials& trials, const model::Tolerances& tolerances) {
  Json json;
  json["nominal"] = figures_of(trials.nominal);
  for (const Trials::Single& single : trials.singles) {
    const model::Tolerance& tolerance = model::tolerance_table[single.tolerance];
    json["single"].push_back({{"name", tolerance.name},
                              {"tolerance", tolerances[single.tolerance]},
                              {"unit", tolerance.unit},
                              {"minus", figures_of(single.minus)},
                              {"plus", figures_of(single.plus)}});
  }
  json["exact"] = model::exact_quantities(tolerances);
  json["costliest"] = model::tolerance_table[trials.costliest].name;
  json["printers"] = trials.printers;
  if (trials.printers > 0) json["yield"] = static_cast<double>(trials.good) / trials.printers;
  return json;
}

}  // namespace vam::optimize
