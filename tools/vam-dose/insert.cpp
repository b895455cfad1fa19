// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-dose/insert.hpp"

#include <algorithm>
#include <numeric>

#include "light/operators/insert.hpp"
#include "model/dose/dose_metrics.hpp"

namespace vam::dose_tool {

namespace {

Image read_slice(const io::SparseVolume& volume, int k, int nx, int ny) {
  Image image(nx, ny);
  volume.read_slices(k, 1, image.values.data());
  return image;
}

}  // namespace

Insert::Insert(const io::SparseVolume* insert, const io::SparseVolume* target, const model::Grid& grid,
               const model::StackInfo& light)
    : insert_(insert), target_(target), nx_(grid.nx), ny_(grid.ny) {
  if (insert_ == nullptr) return;
  even_ = Image(light.width, light.height, 1.0F);
  rows_ = light.count;
}

std::vector<Image> Insert::slices(int first, int count) const {
  std::vector<Image> slices;
  if (insert_ == nullptr) return slices;
  bool opaque = false;
  for (int k = first; k < first + count; ++k) {
    slices.push_back(read_slice(*insert_, k, nx_, ny_));
    opaque = opaque || std::ranges::any_of(slices.back().values, light::opaque);
  }
  if (!opaque) slices.clear();
  return slices;
}

void Insert::look_for_dark(const light::Simulation& simulation, int first, std::span<const Image> inserts) {
  if (target_ == nullptr || inserts.empty()) return;
  std::vector<Image> distinct;  // a shaft is the same in many slices
  std::vector<std::size_t> which;
  for (const Image& insert : inserts) {
    if (distinct.empty() || distinct.back().values != insert.values) distinct.push_back(insert);
    which.push_back(distinct.size() - 1);
  }
  std::vector<Image> lit(distinct.size());
  if (simulation.climbs()) {
    distinct.assign(inserts.begin(), inserts.end());
    std::iota(which.begin(), which.end(), std::size_t{0});
    lit.resize(distinct.size());
  }
  simulation.dose(std::vector<Image>(simulation.climbs() ? static_cast<std::size_t>(rows_) : distinct.size(), even_),
                  lit, distinct);
  float most = 0;
  for (const Image& dose : lit) most = std::max(most, *std::max_element(dose.values.begin(), dose.values.end()));
  for (std::size_t s = 0; s < inserts.size(); ++s) {
    const Image part = read_slice(*target_, first + static_cast<int>(s), nx_, ny_);
    for (std::size_t p = 0; p < part.size(); ++p) {
      const bool printed = model::label_of(part.values[p]) == model::Label::part;
      if (printed && light::in_shadow(lit[which[s]].values[p], most)) ++dark_;
    }
  }
}

}  // namespace vam::dose_tool
