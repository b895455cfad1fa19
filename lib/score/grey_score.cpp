// SPDX-License-Identifier: GPL-3.0-or-later
#include "score/grey_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "model/dose/figures.hpp"
#include "verdict/verdict.hpp"

namespace vam::score {

namespace {

struct Figure {
  std::string name;
  std::string meaning;
};

const std::vector<Figure>& figure_list() {
  static const std::vector<Figure> all{
      {"ver", "fraction of the voxels whose dose is out of the band around the target"},
      {"pw", "- maximum of error - band, negative if a voxel is out of its band"},
      {"ipdr", "maximum error"},
      {"cv", "root mean square error"},
      {"iou", "1 - ver"},
      {"bias", "mean of dose - target in the part"},
      {"prints", "1 if the verdict is 'met', else 0"},
  };
  return all;
}

}  // namespace

GreyScore::GreyScore(const GreyOptions& options, int width, int height)
    : options_(options), width_(width), height_(height), worst_(-std::numeric_limits<double>::infinity()) {}

void GreyScore::add(const float* dose, const float* target, int count, const float* band) {
  one_band_ = one_band_ && band == nullptr;
  for (std::size_t i = 0; i < product(count, product(width_, height_)); ++i) {
    const auto in_slice = static_cast<int>(i % product(width_, height_));
    const bool is_void = target[i] <= model::coverage_rounding;
    if (!std::isfinite(dose[i])) throw Error{Fault::data, "the dose is not finite everywhere; compute it again"};
    const bool judged = !is_void || (options_.void_rule != VoidRule::free &&
                                     options_.circle.contains(in_slice % width_, in_slice / width_));
    if (!judged) continue;
    const double error = static_cast<double>(dose[i]) / options_.unit - static_cast<double>(target[i]);
    const bool limited = is_void && options_.void_rule == VoidRule::below;
    // Below the limit the void is right, whatever its dose.
    const double size = limited ? std::max(0.0, error - options_.void_limit) : std::abs(error);
    const double usual = band != nullptr ? static_cast<double>(band[i]) : options_.band;
    const double allowed = is_void ? options_.void_band.value_or(usual) : usual;
    const double beyond = limited ? error - options_.void_limit : size - allowed;
    ++(is_void ? void_ : part_);
    wrong_ += beyond > 0 ? 1 : 0;
    worst_ = std::max(worst_, beyond);
    largest_ = std::max(largest_, size);
    squares_ += size * size;
    if (!is_void) mismatch_ += error;
  }
}

const std::vector<std::string>& GreyScore::names() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> list;
    for (const auto& figure : figure_list()) list.push_back(figure.name);
    return list;
  }();
  return all;
}

model::DoseMetrics GreyScore::metrics() const {
  const auto all = static_cast<double>(part_ + void_);
  model::DoseMetrics m{.part = part_, .void_ = void_, .ver = static_cast<double>(wrong_) / all};
  m.pw = -worst_;
  m.ipdr = largest_;
  m.cv = std::sqrt(squares_ / all);
  m.iou = 1 - m.ver;
  return m;
}

double GreyScore::figure(const std::string& name) const {
  if (name == "prints") return is_met() ? 1 : 0;
  return name == "bias" ? mismatch_ / static_cast<double>(part_) : model::figure(metrics(), name);
}

Json GreyScore::figures() const {
  if (part_ == 0) throw Error{Fault::data, "the target is 0 everywhere; there is nothing to compare"};
  Json json;
  json["part_voxels"] = part_;
  json["void_voxels"] = void_;
  json["band"] = options_.band;
  json["dose_unit"] = options_.unit;
  for (const std::string& name : names()) json[name] = figure(name);
  return json;
}

std::string GreyScore::table() const {
  const Json values = figures();
  std::string text;
  for (const auto& [name, meaning] : figure_list()) text += figure_row(name, values[name].get<double>(), meaning);
  return text + "verdict      " + verdict() + "\n";
}

std::string GreyScore::verdict() const {
  const bool alike = one_band_ && (!options_.void_band || options_.void_rule != VoidRule::met);
  return verdict::grey_words(metrics(), alike ? std::optional(options_.band) : std::nullopt);
}

}  // namespace vam::score
