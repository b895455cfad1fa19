// SPDX-License-Identifier: GPL-3.0-or-later
#include "score/score.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "model/dose/figures.hpp"

namespace vam::score {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

template <auto Find, auto Value>
Json known(const Score& score) {
  const auto found = (score.*Find)();
  return found ? static_cast<double>((*found).*Value) : none;
}

constexpr std::pair<const char*, const char*> of_doses[] = {  // of model::figure()
    {"latitude", "minimum part dose - maximum void dose, of their middle: half of it is forgiven either way"},
    {"ver", "voxel error rate: void voxels with at least the minimum part dose, as a fraction of all voxels"},
    {"pw", "process window: minimum part dose - maximum void dose (> 0: a threshold prints the part exactly)"},
    {"ipdr", "in-part dose range: maximum - minimum part dose"},
    {"cv", "coefficient of variation of the part dose"},
    {"iou", "|print and part| / |print or part| at the best threshold"},
    {"threshold", "best threshold"},
    {"min_part", "minimum dose in the part"},
    {"mean_part", "mean dose in the part"},
    {"max_part", "maximum dose in the part"},
    {"max_void", "maximum dose in the void"},
    {"max_dose", "maximum dose"}};

double number(const Json& value) { return value.is_null() ? none : value.get<double>(); }

}  // namespace

struct Score::Figure {
  std::string name;
  std::string meaning;
  std::function<Json(const Score& of)> value;  // null or NaN where it is not known
};

const std::vector<Score::Figure>& Score::figure_list() {
  using model::ThresholdMetrics;
  static const std::vector<Figure> all = [] {
    std::vector<Figure> list;
    for (const auto& [name, meaning] : of_doses)
      list.push_back({name, meaning, [of = name](const Score& score) { return model::figure(score.metrics(), of); }});
    list.insert(list.end(), {{"outside_voxels", "void voxels outside the box around the part",
                              known<&Score::outside, &model::StrayCure::voxels>},
                             {"outside_gelled_voxels", "void voxels outside the box that gel in the print",
                              known<&Score::outside, &model::StrayCure::gelled_voxels>},
                             {"outside_max_dose", "maximum dose of void voxels outside the box",
                              known<&Score::outside, &model::StrayCure::max_dose>}});
    for (const verdict::Figure& of : verdict::figures())
      list.push_back({of.name, of.meaning, [value = of.value](const Score& score) { return value(score.verdict()); }});
    list.insert(
        list.end(),
        {{"trimmed_ver", "ver with the extremes trimmed", [](const Score& score) { return score.trimmed().ver; }},
         {"trimmed_pw", "pw with the extremes trimmed", [](const Score& score) { return score.trimmed().pw; }},
         {"cured_part", "at the critical dose: fraction of the part that cures",
          known<&Score::at_critical, &ThresholdMetrics::part_cured>},
         {"cured_void", "at the critical dose: fraction of the void that cures",
          known<&Score::at_critical, &ThresholdMetrics::void_cured>},
         {"cured_iou", "at the critical dose: |print and part| / |print or part|",
          known<&Score::at_critical, &ThresholdMetrics::iou>},
         {"cured_wrong", "at the critical dose: fraction of wrong voxels",
          known<&Score::at_critical, &ThresholdMetrics::wrong>},
         {"turns", "whole turns that put the critical dose in the middle half of the process window",
          known<&Score::plan, &ExposurePlan::turns>},
         {"duration_s", "duration of these turns", known<&Score::plan, &ExposurePlan::seconds>},
         {"multiplier", "fraction of full intensity during these turns",
          known<&Score::plan, &ExposurePlan::multiplier>},
         {"peak_intensity_mw_cm2", "intensity of the brightest pixel during these turns, mW/cm2",
          known<&Score::plan, &ExposurePlan::peak_intensity_mw_cm2>},
         {"efficiency", "mean / maximum of the projections",
          [](const Score& score) { return score.light_.count > 0 ? score.light_.value() : none; }}});
    return list;
  }();
  return all;
}

bool is_of_exposure(const std::string& figure) {
  return figure == "turns" || figure == "duration_s" || figure == "multiplier" || figure == "peak_intensity_mw_cm2";
}

Score::Score(const ScoreOptions& options, int width, int height)
    : options_(options),
      width_(width),
      region_(width, height, options.circle),
      whole_(options.threshold),
      with_cut_(options.threshold) {
  const model::Circle& at = options.circle;
  rim_px_ = 0.5 + std::min({at.axis_x, at.axis_y, width - 1 - at.axis_x, height - 1 - at.axis_y});
}

void Score::add(const float* dose, const float* target, int count) {
  std::vector<model::DoseStatistics> slices;
  std::vector<model::DoseStatistics> cut;
  for (int s = 0; s < count; ++s) {
    slices.emplace_back(options_.threshold);
    cut.emplace_back(options_.threshold);
  }
  std::vector<model::StrayDoses> outside(slices.size());
  std::vector<std::int64_t> surface(count, 0);
  parallel_for(count, [&](int s) {
    const std::size_t first = product(s, region_.pixels());
    for (std::size_t i = 0; i < region_.pixels(); ++i) {
      const float d = dose[first + i];
      const float f = target[first + i];
      if (!std::isfinite(d)) throw Error{Fault::data, "the dose is not finite everywhere; compute it again"};
      const auto label = model::label_of(f);
      if (!region_.has(i, f)) continue;
      if (label == model::Label::surface) {
        ++surface[s];
        cut[s].add(d, model::half_covered(f) ? model::Label::part : model::Label::void_);
      }
      slices[s].add(d, label);
      if (options_.part && label == model::Label::void_ && !in_box(i, slices_ + s)) outside[s].add(d);
    }
  });
  for (int s = 0; s < count; ++s) {
    whole_.merge(slices[s]);
    with_cut_.merge(slices[s]);
    with_cut_.merge(cut[s]);
    outside_.merge(outside[s]);
    surface_ += surface[s];
  }
  slices_ += count;
}

std::optional<model::StrayCure> Score::outside() const {
  if (!options_.part) return std::nullopt;
  return outside_.at(print_threshold());
}

std::optional<model::ThresholdMetrics> Score::at_critical() const {
  const auto at = judged().at_threshold();
  return at || !options_.exposure ? at : judged().at(print_threshold());
}

const std::vector<std::string>& Score::names() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> list;
    for (const auto& figure : figure_list()) list.push_back(figure.name);
    return list;
  }();
  return all;
}

double Score::figure(const std::string& name) const {
  const auto& all = figure_list();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Figure& figure) { return figure.name == name; });
  return found != all.end() ? number(found->value(*this)) : none;
}

std::optional<ExposurePlan> Score::plan() const {
  if (!options_.exposure) return std::nullopt;
  const model::DoseMetrics doses = whole_.metrics(false);
  if (!(verdict::window_middle(doses) > 0)) return std::nullopt;
  return plan_exposure(doses, 1 / options_.exposure->full_intensity_turns.value_or(1), options_.exposure->printer, 1,
                       options_.aimed_at);
}

verdict::PrintThreshold Score::sets_at() const {
  std::optional<double> of_exposure = options_.threshold;
  if (const auto plan = of_exposure ? std::nullopt : this->plan())
    of_exposure = *options_.exposure->printer.resin.critical_dose_mj_cm3 / (plan->turns * plan->multiplier);
  return verdict::print_threshold(whole_.metrics(false), of_exposure, options_.aimed_at);
}

Json Score::figures() const {
  const auto m = metrics();
  if (m.part == 0) {
    throw Error{Fault::data,
                options_.target +
                    ": no voxel of it is wholly inside the part; slice it with smaller voxels, at "
                    "most half as large as its thinnest wall, thicken the part, or judge doses with --grey-target"};
  }
  if (m.void_ == 0) {
    throw Error{Fault::data, options_.target +
                                 ": no voxel of it is void inside the writable circle, and there is nothing to "
                                 "compare; scale the part down, or slice it with --extent writable"};
  }
  if (m.max_dose == 0) throw Error{Fault::data, "the dose is 0 everywhere: the projections are dark, nothing prints"};
  Json json;
  json["part_voxels"] = m.part;
  json["void_voxels"] = m.void_;
  json["surface_voxels"] = surface_;
  for (const auto& [name, meaning, value_of] : figure_list()) {
    if (const Json value = value_of(*this); std::isfinite(number(value))) json[name] = value;
  }
  add_findings(json, verdict());
  if (const auto radius_mm = judged_radius_mm()) json["judged_radius_mm"] = *radius_mm;
  json["trim"] = options_.trim;
  if (print_threshold() > 0) json["print_threshold"] = print_threshold();
  if (options_.threshold) json["critical_dose"] = *options_.threshold;
  if (options_.exposure && !options_.threshold) json["critical_dose_per_turn"] = print_threshold();
  json["relative"] = !options_.absolute;
  return json;
}

verdict::Verdict Score::verdict() const {
  verdict::GivenPrint print{whole_.metrics(), with_cut_.metrics(), pieces_,
                            options_.grid,    options_.stretch_z,  options_.light};
  print.threshold = options_.threshold;
  if (const verdict::PrintThreshold at = sets_at(); at.best && pieces_) print.best = at.dose;
  if (print.threshold) {
    if (options_.exposure) print.seconds = options_.exposure->seconds;
  } else if (const auto plan = this->plan()) {
    print.seconds = plan->seconds;
  }
  return verdict::judge(options_.unresolved, print);
}

std::optional<double> Score::judged_radius_mm() const {
  constexpr double least_px = 0.5;  // the writable circle's own voxels end within it
  const double voxel_mm = options_.grid.voxel_mm;
  const double judged_mm = std::min(rim_px_, options_.circle.radius) * voxel_mm;
  return judged_mm < options_.writable_mm - least_px * voxel_mm ? std::optional(judged_mm) : std::nullopt;
}

std::string Score::table(const std::string& ending) const {
  const Json values = figures();
  std::string text;
  for (const auto& [name, meaning, value] : figure_list()) {
    if (values.contains(name)) text += figure_row(name, values[name].get<double>(), meaning);
  }
  if (const auto radius_mm = judged_radius_mm()) {
    text += "judged       all void within " + format_number(*radius_mm, 3) + " mm of the axis; the " +
            (rim_px_ < options_.circle.radius ? "volume" : "light") + " ends before the writable radius of " +
            format_number(options_.writable_mm, 3) + " mm\n";
  }
  if (options_.stated) {
    text += "judged at    the critical dose that is given, " + format_number(*options_.threshold) +
            "; the dose states " + format_number(*options_.stated) + "\n";
  }
  return text + "verdict      " + verdict().words + ending + "\n";
}

}  // namespace vam::score
