// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/yield.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "base/log/progress.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "light/grids/poses.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/run/private/shown_pass.hpp"
#include "optimize/target/exclusions.hpp"

namespace vam::optimize {

namespace {

constexpr std::uint64_t seed = 13;

/// The voxels to be judged and the inserts in the light's way.
class Bench {
 public:
  Bench(const Trial& trial, const VolumeTask& task, const Frames& frames)
      : trial_(trial), frames_(frames), setup_(trial.printer.setup(trial.printer.printer)), input_(read(trial, task)) {
    if (!input_.inserts.empty()) exclude(input_.problem, input_.inserts);
  }

  [[nodiscard]] Printed print(const model::PrinterDeviation& by) const {
    const Scenario off = scenario_of(trial_.printer, by, input_.inserts);
    const PassLight light(*off.light, nullptr, off.blur_px, trial_.grid.nz);
    const auto seen = [&](int k) { return dimmed(frames_.at(k, off.light->image()), k, off.rim); };
    return judged(dose_of(all(), light, seen), off.intensity);
  }

  [[nodiscard]] Printed print(std::size_t tolerance, double multiple) const {
    model::PrinterDeviation by{};
    by[tolerance] = multiple;
    return print(by);
  }

  /// Whether light is known in a printer that deviates so much: a vial may be moved by so much only.
  [[nodiscard]] bool knows(std::size_t tolerance, double multiple) const {
    const auto kind = static_cast<model::ToleranceKind>(tolerance);
    if (kind != model::ToleranceKind::vial_x && kind != model::ToleranceKind::vial_y) return true;
    return light::may_move(trial_.printer.printer, setup_.radius_mm, multiple * trial_.printer.tolerances[tolerance]);
  }

 private:
  /// Row k of light, where its height in the plane of the rotation axis is in the projector's image.
  [[nodiscard]] Image dimmed(Image image, int k, double rim) const {
    if (rim == 0) return image;
    const double low_mm = setup_.rows > 0 ? setup_.first_row_mm : setup_.grid.z_mm(0);
    const double z = low_mm + k * setup_.grid.voxel_mm;
    const model::Projector& p = trial_.printer.printer.projector;
    const double half_x = 0.5 * (p.columns - 1), half_y = 0.5 * (p.rows - 1);
    const double y = p.axis_row - z / p.pixel_mm - half_y;
    for (int x = 0; x < image.width; ++x) {
      const double share = ((x - half_x) * (x - half_x) + y * y) / (half_x * half_x + half_y * half_y);
      for (int a = 0; a < image.height; ++a) image(x, a) *= static_cast<float>(1 - rim * share);
    }
    return image;
  }

  [[nodiscard]] Pass all() const { return {0, trial_.grid.nz, 0, trial_.grid.nz}; }
  [[nodiscard]] PassInput read(const Trial& trial, const VolumeTask& task) const {
    const SliceReader reader(task.source, {trial.grid.nx, trial.grid.ny});
    return read_pass(
        all(), [](int k) { return k; }, reader, {trial.grid.nx, trial.grid.ny}, task.circle, task.demands, true);
  }

  [[nodiscard]] Printed judged(std::vector<Slab> dose, double intensity) const {
    const auto unit = static_cast<float>(intensity / trial_.threshold);
    for (Slab& slab : dose)
      for (float& value : slab.values) value *= unit;
    model::DoseStatistics all(1.0);
    for (const auto& slice : whole_statistics(dose, input_.problem, 1.0)) all.merge(slice);
    return {all.metrics(false), all.at_threshold()->wrong};
  }

  const Trial& trial_;
  const Frames& frames_;
  light::VialSetup setup_;  // of the printer as set
  PassInput input_;
};

using Margin = std::function<double(double multiple)>;

/// The multiple, up to `reach`, at which the margin is lost, to 2 %: by doubling, then by secants that step a little
/// beyond the root, to both sides in turn. 0: none. One below `least` may be a step of the model.
double end(const Margin& margin, double at_low, double at_high, double reach) {
  constexpr double sure = 0.02, least = 0.01;
  double low = 0, high = 1;
  while (at_high > 0) {
    if (high >= reach) return 0;
    low = high;
    at_low = at_high;
    at_high = margin(high *= 2);
  }
  for (bool beyond = true; high - low > sure * high && high > least;) {
    const double root = low + (high - low) * at_low / std::max(at_low - at_high, 1e-12);
    const double tenth = 0.1 * (high - low);
    const double x = std::clamp(root + (beyond ? 0.4 : -0.4) * sure * high, low + tenth, high - tenth);
    const double at_x = margin(x);
    beyond = at_x > 0;
    (beyond ? low : high) = x;
    (beyond ? at_low : at_high) = at_x;
  }
  return 0.5 * (low + high);
}

std::vector<Single> singles_of(const Trial& trial, const Bench& bench) {
  std::vector<Single> all;
  for (std::size_t i = 0; i < trial.printer.tolerances.size(); ++i) {
    if (trial.printer.tolerances[i] == 0 || !bench.knows(i, 1)) continue;
    const Printed plus = bench.print(i, 1);
    all.push_back({i, model::tolerance_table[i].one_way ? plus : bench.print(i, -1), plus});
  }
  return all;
}

bool is_costlier(const Single& a, const Single& b) { return a.least_margin() < b.least_margin(); }

/// The least of their tolerance first.
void find_ends(std::vector<Single>& singles, const Trial& trial, const Bench& bench, double as_set) {
  std::stable_sort(singles.begin(), singles.end(), is_costlier);
  double reach = singles.front().least_margin() > 0 ? farthest_end : 1;
  for (Single& one : singles) {
    for (const double way : {1.0, -1.0}) {
      if (way < 0 && model::tolerance_table[one.tolerance].one_way) continue;
      const Margin at = [&](double multiple) { return bench.print(one.tolerance, way * multiple).margin(); };
      while (reach > 1 && !bench.knows(one.tolerance, reach)) reach /= 2;
      const double found = way * end(at, as_set, (way > 0 ? one.plus : one.minus).margin(), reach);
      if (one.ends_at == 0 || (found != 0 && std::abs(found) < std::abs(one.ends_at))) one.ends_at = found;
    }
    reach = 1;
  }
  const auto share = [](const Single& one) { return one.ends_at == 0 ? farthest_end : std::abs(one.ends_at); };
  std::stable_sort(singles.begin(), singles.end(), [&](const auto& a, const auto& b) { return share(a) < share(b); });
  for (Single& one : singles) one.ends_at *= trial.printer.tolerances[one.tolerance];
}

std::string amount(double value, const model::Tolerance& of) {
  return format_number(value, 2) + (of.unit.empty() ? "" : " ") + std::string(of.unit);
}

}  // namespace

double Single::least_margin() const { return std::min(minus.margin(), plus.margin()); }

double Printed::margin() const { return std::min(figures.min_part - 1, 1 - figures.max_void); }

Printed print_as_set(const Trial& trial, const VolumeTask& task, const Frames& frames) {
  return Bench(trial, task, frames).print({});
}

Trials run_trials(const Trial& trial, const VolumeTask& task, const Frames& frames) {
  const Bench bench(trial, task, frames);
  Progress progress("judging", trial.printers);
  Trials trials;
  trials.tolerances = trial.printer.tolerances;
  trials.nominal = bench.print({});
  trials.singles = singles_of(trial, bench);
  trials.costliest = std::min_element(trials.singles.begin(), trials.singles.end(), is_costlier)->tolerance;
  if (const double margin = trials.nominal.margin(); trial.ends && margin > 0)
    find_ends(trials.singles, trial, bench, margin);
  for (; trials.printers < trial.printers; ++trials.printers) {
    if (bench.print(model::drawn_deviation(seed, trials.printers)).wrong <= allowed_wrong) ++trials.good;
    progress.tick();
  }
  return trials;
}

std::string words_of_ends(const Trials& trials, bool prints) {
  if (!prints || !(trials.nominal.margin() > 0))
    return "; no deviation ends it, as it does not print with the printer as set";
  std::string text;
  for (const Single& one : trials.singles) {
    const model::Tolerance& of = model::tolerance_table[one.tolerance];
    if (one.ends_at == 0) continue;
    text += (text.empty() ? "; " : ", then ") + std::string(of.name) + " of " +
            (of.one_way        ? ""
             : one.ends_at < 0 ? "-"
                               : "+") +
            amount(std::abs(one.ends_at), of) + " (expected: " + amount(trials.tolerances[one.tolerance], of) + ")" +
            (text.empty() ? " ends it first" : "");
  }
  return text.empty() ? "; no deviation that is expected of the printer ends it, nor the worst of them eightfold"
                      : text;
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

Json report(const Trials& trials) {
  Json json;
  json["nominal"] = figures_of(trials.nominal);
  for (const Single& single : trials.singles) {
    const model::Tolerance& tolerance = model::tolerance_table[single.tolerance];
    json["single"].push_back({{"name", tolerance.name},
                              {"tolerance", trials.tolerances[single.tolerance]},
                              {"unit", tolerance.unit},
                              {"minus", figures_of(single.minus)},
                              {"plus", figures_of(single.plus)}});
    if (single.ends_at != 0) json["single"].back()["ends_at"] = single.ends_at;
  }
  json["exact"] = model::exact_quantities(trials.tolerances);
  json["costliest"] = model::tolerance_table[trials.costliest].name;
  json["printers"] = trials.printers;
  if (trials.printers > 0) json["yield"] = static_cast<double>(trials.good) / trials.printers;
  return json;
}

}  // namespace vam::optimize
