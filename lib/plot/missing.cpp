// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/missing.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "model/dose/dose_metrics.hpp"
#include "verdict/defect_voxels.hpp"

namespace vam::plot {

namespace {

constexpr int slab = 16;

/// Slices of both volumes, with one more below and above.
class Window {
 public:
  Window(const io::SparseVolume& target, const io::SparseVolume* dose, double threshold, int first)
      : grid_(target.grid()), first_(first), threshold_(threshold) {
    low_ = std::max(first - 1, 0);
    high_ = std::min(first + slab + 1, grid_.nz);
    covered_ = slices_of(target);
    if (dose != nullptr) doses_ = slices_of(*dose);
  }
  [[nodiscard]] int count() const { return std::min(slab, grid_.nz - first_); }
  [[nodiscard]] const float* coverage(int k) const { return slice(covered_, k); }
  [[nodiscard]] bool cures(int k, std::size_t at) const {
    return !doses_.empty() && static_cast<double>(slice(doses_, k)[at]) >= threshold_;
  }
  /// Of a slice, with the one below and the one above.
  [[nodiscard]] std::vector<std::size_t> lost(int k) const {
    const std::array<const float*, 3> around{slice(covered_, k - 1), slice(covered_, k), slice(covered_, k + 1)};
    return verdict::lost_walls(grid_.nx, grid_.ny, around.data());
  }
  [[nodiscard]] std::vector<std::uint8_t> bits(int k) const {
    std::vector<std::uint8_t> all(is_in(k) ? grid_.slice_size() : 0);
    for (std::size_t at = 0; at < all.size(); ++at) all[at] = verdict::printed_bits(coverage(k)[at], cures(k, at));
    return all;
  }

 private:
  [[nodiscard]] std::vector<float> slices_of(const io::SparseVolume& volume) const {
    std::vector<float> slices(product(high_ - low_, grid_.slice_size()));
    volume.read_slices(low_, high_ - low_, slices.data());
    return slices;
  }
  [[nodiscard]] bool is_in(int k) const { return k >= low_ && k < high_; }
  [[nodiscard]] const float* slice(const std::vector<float>& slices, int k) const {
    return is_in(k) ? slices.data() + product(k - low_, grid_.slice_size()) : nullptr;
  }

  const model::Grid& grid_;
  int first_;
  double threshold_;
  int low_ = 0, high_ = 0;
  std::vector<float> covered_, doses_;
};

void add_missing(const Window& window, int k, const std::array<const std::uint8_t*, 3>& bits, const model::Grid& grid,
                 float* shares) {
  const float* coverage = window.coverage(k);
  for (std::size_t at = 0; at < grid.slice_size(); ++at) {
    if (model::label_of(coverage[at]) == model::Label::part && !window.cures(k, at)) shares[at] = coverage[at];
  }
  for (const std::size_t at : window.lost(k)) {
    if (!window.cures(k, at)) shares[at] = coverage[at];
  }
  for (const std::size_t at : verdict::defect_voxels(verdict::Defect::broken, grid.nx, grid.ny, bits.data()))
    shares[at] = coverage[at];
}

}  // namespace

int MissingPart::section(Plane plane) const {
  const std::vector<double>& sums = along[plane == Plane::axial ? 2 : plane == Plane::coronal ? 1 : 0];
  const int middle = count_of(sums) / 2;
  const double most = *std::max_element(sums.begin(), sums.end());
  int nearest = middle;
  int steps = count_of(sums);
  for (int n = 0; n < count_of(sums); ++n) {
    if (sums[n] < 0.5 * most || std::abs(n - middle) >= steps) continue;
    nearest = n;
    steps = std::abs(n - middle);
  }
  return nearest;
}

MissingPart missing_part(const io::SparseVolume& dose, const io::SparseVolume& target, double threshold) {
  const model::Grid& grid = target.grid();
  MissingPart found{io::SparseVolume("missing", grid), {}};
  found.along = {std::vector<double>(grid.nx), std::vector<double>(grid.ny), std::vector<double>(grid.nz)};
  for (int k0 = 0; k0 < grid.nz; k0 += slab) {
    const Window window(target, &dose, threshold, k0);
    std::vector<std::vector<std::uint8_t>> bits(window.count() + 2);
    parallel_for(count_of(bits), [&](int n) { bits[n] = window.bits(k0 + n - 1); });
    const auto data = [&](int n) { return bits[n].empty() ? nullptr : bits[n].data(); };
    std::vector<float> shares(product(window.count(), grid.slice_size()), 0.0F);
    parallel_for(window.count(), [&](int n) {
      add_missing(window, k0 + n, {data(n), data(n + 1), data(n + 2)}, grid,
                  shares.data() + product(n, grid.slice_size()));
    });
    for (std::size_t at = 0; at < shares.size(); ++at) {
      if (shares[at] == 0) continue;
      const auto share = static_cast<double>(shares[at]);
      const std::size_t in_slice = at % grid.slice_size();
      found.along[0][in_slice % static_cast<std::size_t>(grid.nx)] += share;
      found.along[1][in_slice / static_cast<std::size_t>(grid.nx)] += share;
      found.along[2][static_cast<std::size_t>(k0) + at / grid.slice_size()] += share;
    }
    found.shares.write_slices(k0, window.count(), shares.data());
  }
  return found;
}

io::SparseVolume lost_wall_volume(const io::SparseVolume& target, const io::SparseVolume* dose, double threshold) {
  const model::Grid& grid = target.grid();
  io::SparseVolume found("lost", grid);
  for (int k0 = 0; k0 < grid.nz; k0 += slab) {
    const Window window(target, dose, threshold, k0);
    std::vector<float> lost(product(window.count(), grid.slice_size()), 0.0F);
    parallel_for(window.count(), [&](int n) {
      for (const std::size_t at : window.lost(k0 + n)) {
        if (!window.cures(k0 + n, at)) lost[product(n, grid.slice_size()) + at] = 1;
      }
    });
    found.write_slices(k0, window.count(), lost.data());
  }
  return found;
}

}  // namespace vam::plot
