// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/insert_fit.hpp"

#include <algorithm>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "model/dose/dose_metrics.hpp"

namespace vam::solid {

namespace {

std::size_t place(const model::Grid& grid, int i, int j) { return flat_index(j, grid.nx, i); }

}  // namespace

GrownInsert::GrownInsert(const model::Grid& grid, const std::function<void(int k, float* out)>& read,
                         double clearance_mm, double stretch_z)
    : grid_(grid), clearance_px_(clearance_mm / grid.voxel_mm), stretch_z_(stretch_z), rims_(grid.nz) {
  if (clearance_mm <= 0) return;
  std::vector<float> below(grid.slice_size(), 0.0F);
  std::vector<float> here(grid.slice_size(), 0.0F);
  std::vector<float> above(grid.slice_size(), 0.0F);
  read(0, here.data());
  const auto nx = static_cast<std::size_t>(grid.nx);
  for (int k = 0; k < grid.nz; ++k) {
    std::fill(above.begin(), above.end(), 0.0F);
    if (k + 1 < grid.nz) read(k + 1, above.data());
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        const std::size_t at = place(grid, i, j);
        if (here[at] <= 0) continue;
        const bool rim = here[at] < 1 || below[at] < 1 || above[at] < 1 || (i > 0 && here[at - 1] < 1) ||
                         (i + 1 < grid.nx && here[at + 1] < 1) || (j > 0 && here[at - nx] < 1) ||
                         (j + 1 < grid.ny && here[at + nx] < 1);
        if (rim) rims_[k].push_back({i, j, here[at]});
      }
    }
    below.swap(here);
    here.swap(above);
  }
}

void GrownInsert::grow(int k, float* slice) const {
  const double reach = clearance_px_ + 1;
  const int slices = ceil_int(reach * stretch_z_);
  for (int from = std::max(0, k - slices); from <= std::min(grid_.nz - 1, k + slices); ++from) {
    const double dz = (from - k) / stretch_z_;
    const double across = reach * reach - dz * dz;
    if (across < 0) continue;
    const int span = static_cast<int>(std::sqrt(across));
    for (const Rim& rim : rims_[from]) {
      for (int j = std::max(0, rim.j - span); j <= std::min(grid_.ny - 1, rim.j + span); ++j) {
        for (int i = std::max(0, rim.i - span); i <= std::min(grid_.nx - 1, rim.i + span); ++i) {
          const double far = std::sqrt(dz * dz + (i - rim.i) * (i - rim.i) + (j - rim.j) * (j - rim.j));
          const double covered = static_cast<double>(rim.coverage) + clearance_px_ - far;
          float& value = slice[place(grid_, i, j)];
          value = std::max(value, static_cast<float>(std::clamp(covered, 0.0, 1.0)));
        }
      }
    }
  }
}

void InsertFit::add(const float* part, const float* insert) {
  last_part_.resize(grid_.slice_size(), 0.0F);
  bool has_part = false;
  bool has_insert = false;
  for (int j = 0; j < grid_.ny; ++j) {
    for (int i = 0; i < grid_.nx; ++i) {
      const std::size_t at = place(grid_, i, j);
      has_part = has_part || part[at] > 0;
      if (insert[at] <= 0) continue;
      has_insert = true;
      insert_ += insert[at];
      shared_ += std::max(0.0, static_cast<double>(part[at]) + static_cast<double>(insert[at]) - 1);
      if (last_part_[at] > 0 || touches(part, i, j)) ++contact_;
    }
  }
  if (has_insert) ++slices_;
  if (has_insert && has_part) ++common_slices_;
  std::copy_n(part, last_part_.size(), last_part_.begin());
  follow_lines(part, insert);
}

void InsertFit::follow(Line& line, float part, float insert) {
  constexpr float enough = 0.75F;
  if (!model::half_covered(part) && !model::half_covered(insert)) {
    line.steps = static_cast<std::uint8_t>(std::min(line.steps + 1, 255));
    line.free = line.free || 1 - part - insert >= enough;
    return;
  }
  const Line::Met here = model::half_covered(insert) ? Line::Met::insert : Line::Met::part;
  if (line.met != Line::Met::nothing && line.met != here && line.steps <= reach_) {
    ++lines_;
    if (!line.free) ++shut_;
  }
  line = {here, 0, false};
}

void InsertFit::follow_lines(const float* part, const float* insert) {
  upwards_.resize(grid_.slice_size());
  std::vector<Line> along_y(static_cast<std::size_t>(grid_.nx));
  for (int j = 0; j < grid_.ny; ++j) {
    Line along_x;
    for (int i = 0; i < grid_.nx; ++i) {
      const std::size_t at = place(grid_, i, j);
      follow(along_x, part[at], insert[at]);
      follow(along_y[static_cast<std::size_t>(i)], part[at], insert[at]);
      follow(upwards_[at], part[at], insert[at]);
    }
  }
}

bool InsertFit::touches(const float* part, int i, int j) const {
  if (part[place(grid_, i, j)] > 0) return true;
  for (int step = 1; step <= reach_; ++step) {
    for (const int x : {i - step, i + step}) {
      if (x >= 0 && x < grid_.nx && part[place(grid_, x, j)] > 0) return true;
    }
    for (const int y : {j - step, j + step}) {
      if (y >= 0 && y < grid_.ny && part[place(grid_, i, y)] > 0) return true;
    }
  }
  return false;
}

double InsertFit::mm3(double voxels, double stretch_z) const {
  return voxels * grid_.voxel_mm * grid_.voxel_mm * grid_.voxel_mm / stretch_z;
}

double InsertFit::shared_mm3(double stretch_z) const { return mm3(shared_, stretch_z); }

Json InsertFit::figures(double stretch_z) const {
  return {{"volume_mm3", mm3(insert_, stretch_z)},
          {"slices", slices_},
          {"slices_of_part", common_slices_},
          {"contact_voxels", contact_},
          {"shared_mm3", shared_mm3(stretch_z)}};
}

Part without_insert(const Part& part, std::function<void(int k, float* out)> read, double clearance_mm,
                    double stretch_z) {
  Part cut = part;
  cut.surface = {};  // its surface is no longer the part's
  cut.fill = [fill = part.fill, subject = part.subject, read = std::move(read), clearance_mm, stretch_z](
                 const model::Grid& grid, const SliceSink& sink) {
    const GrownInsert grown(grid, read, clearance_mm, stretch_z);
    const std::size_t size = grid.slice_size();
    std::vector<float> left(size * slab);
    bool any = false;
    bool any_left = false;
    const Vote vote = fill(grid, [&](int k0, int count, const float* slices) {
      parallel_for(count, [&](int s) {
        std::vector<float> insert(size);
        read(k0 + s, insert.data());
        grown.grow(k0 + s, insert.data());
        const std::size_t first = product(s, size);
        for (std::size_t n = 0; n < size; ++n) left[first + n] = std::clamp(slices[first + n] - insert[n], 0.0F, 1.0F);
      });
      const auto covers = [&](const float* values) {
        return std::any_of(values, values + product(count, size), [](float value) { return value > 0; });
      };
      any = any || covers(slices);
      any_left = any_left || covers(left.data());
      sink(k0, count, left.data());
    });
    if (!any || any_left) return vote;
    throw Error{Fault::data, subject + ": the insert and its clearance of " + format_number(clearance_mm, 3) +
                                 " mm take all of the part; check --insert-unit, --insert-scale and --insert-at"};
  };
  return cut;
}

}  // namespace vam::solid
