// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/cure_map.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace vam::resin {

namespace {

constexpr double threshold = 1 - dose_tolerance;

}  // namespace

Cure cure_of(double centre_dose, bool solid) {
  const bool cured = centre_dose >= threshold;
  if (solid) return cured ? Cure::correct : Cure::under;
  return cured ? Cure::through : Cure::empty;
}

void FeatureErrors::add(const FeatureErrors& other) {
  features += other.features;
  under += other.under;
  through += other.through;
  worst = std::max(worst, other.worst);
}

FeatureErrors CureTotals::all() const {
  FeatureErrors sum;
  for (const FeatureErrors& errors : by_height) sum.add(errors);
  return sum;
}

CureMap::CureMap(int width, int height, int slices, const CureLimits& limits)
    : width_(width), limits_(limits), pixels_(product(width, height)), rows_(height) {
  for (CureTotals& row : rows_) row.by_height.resize(slices + 1);
}

// Books the pending feature; `extra` is what was cured below it when it is the last of its column.
void CureMap::settle(Pixel& pixel, float extra, CureTotals& totals) {
  if (pixel.pending == 0) return;
  const double through = static_cast<double>(pixel.above) + static_cast<double>(extra);
  const auto under = static_cast<double>(pixel.under);
  totals.by_height[pixel.pending].add({1, under, through, under + through});
  pixel.pending = 0;
}

void CureMap::step(Pixel& pixel, bool solid, double cured, CureTotals& totals) const {
  if (solid) {
    if (pixel.height == 0) {
      settle(pixel, 0, totals);
      pixel.above = pixel.gap;
      pixel.under = 0;
    }
    ++pixel.height;
    pixel.under += static_cast<float>(1 - cured);
    return;
  }
  if (pixel.height > 0) {
    pixel.pending = pixel.height;
    pixel.height = 0;
    pixel.gap = 0;
  }
  pixel.gap += static_cast<float>(cured);
}

void CureMap::add_row(int y, const float* phi, double full, const float* below, const float* solid) {
  CureTotals& totals = rows_[y];
  Pixel* pixel = pixels_.data() + product(y, width_);
  for (int x = 0; x < width_; ++x) {
    const double light = full * static_cast<double>(phi[x]);
    const auto next = static_cast<double>(below[x]);
    const bool in_part = solid[x] >= 0.5F;
    const Cure cure = cure_of(dose_at_centre(light, next, limits_), in_part);
    totals.correct += cure == Cure::correct;
    totals.through += cure == Cure::through;
    totals.under += cure == Cure::under;
    step(pixel[x], in_part, cured_fraction(light, next, threshold, limits_), totals);
  }
}

CureTotals CureMap::finish() {
  CureTotals sum;
  sum.by_height.resize(rows_.empty() ? 1 : rows_.front().by_height.size());
  for (std::size_t y = 0; y < rows_.size(); ++y) {
    CureTotals& row = rows_[y];
    for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) {
      Pixel& pixel = pixels_[y * static_cast<std::size_t>(width_) + x];
      const bool ends_inside = pixel.height > 0;
      if (ends_inside) pixel.pending = pixel.height;
      settle(pixel, ends_inside ? 0 : pixel.gap, row);
    }
    sum.correct += row.correct;
    sum.through += row.through;
    sum.under += row.under;
    for (std::size_t h = 0; h < sum.by_height.size(); ++h) sum.by_height[h].add(row.by_height[h]);
  }
  return sum;
}

CureTotals judge_column(const std::vector<std::uint8_t>& part, const std::vector<double>& phi,
                        const CureLimits& limits) {
  const std::vector<double> omega = dose_at_nodes(phi, limits);
  CureMap map(1, 1, count_of(part), limits);
  for (std::size_t n = 0; n < phi.size(); ++n) {
    const auto light = static_cast<float>(phi[n]);
    const auto below = static_cast<float>(omega[n + 1]);
    const float solid = n < part.size() && part[n] != 0 ? 1.0F : 0.0F;
    map.add_row(0, &light, 1, &below, &solid);
  }
  return map.finish();
}

}  // namespace vam::resin
