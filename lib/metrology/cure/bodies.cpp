// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/cure/bodies.hpp"

#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/disjoint_sets.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/median.hpp"
#include "base/text/json.hpp"
#include "model/dose/stray_cure.hpp"

namespace vam::metrology {

namespace {

/// Voxels first...last - 1 of row (j, k), all on one side of the level.
struct VoxelRun {
  int first;
  int last;
};

/// Runs of all rows, those of row (j, k) from starts[k * ny + j] on, and the component of each.
class Runs {
 public:
  /// reach: 1 where runs touch by corners, 0 where they need a common face.
  Runs(const model::Volume& volume, double level, bool above, int reach) : grid_(volume.grid), reach_(reach) {
    const auto rows = product(grid_.ny, grid_.nz);
    std::vector<std::vector<VoxelRun>> found(rows);
    parallel_for(grid_.nz, [&](int k) {
      for (int j = 0; j < grid_.ny; ++j) {
        const float* in = volume.slice(k) + std::ptrdiff_t{j} * grid_.nx;
        auto& row = found[row_at(j, k)];
        for (int i = 0; i < grid_.nx; ++i) {
          if ((static_cast<double>(in[i]) >= level) != above) continue;
          const int first = i;
          while (i < grid_.nx && (static_cast<double>(in[i]) >= level) == above) ++i;
          row.push_back({first, i});
        }
      }
    });
    starts_.push_back(0);
    for (const auto& row : found) {
      runs_.insert(runs_.end(), row.begin(), row.end());
      starts_.push_back(runs_.size());
    }
    bodies_ = DisjointSets<>(runs_.size());
    for (int k = 0; k < grid_.nz; ++k) {
      for (int j = 0; j < grid_.ny; ++j) join_row(j, k);
    }
  }

  [[nodiscard]] std::size_t size() const { return runs_.size(); }
  [[nodiscard]] std::size_t root(std::size_t run) { return bodies_.of(run); }
  /// work(run index, run, j, k) for all.
  template <class Work>
  void each(const Work& work) const {
    for (int k = 0; k < grid_.nz; ++k) {
      for (int j = 0; j < grid_.ny; ++j) {
        for (std::size_t r = starts_[row_at(j, k)]; r < starts_[row_at(j, k) + 1]; ++r) work(r, runs_[r], j, k);
      }
    }
  }

 private:
  [[nodiscard]] std::size_t row_at(int j, int k) const { return flat_index(k, grid_.ny, j); }

  // With the rows before it that it touches.
  void join_row(int j, int k) {
    if (j > 0) join(row_at(j, k), row_at(j - 1, k));
    if (k == 0) return;
    for (int dj = -reach_; dj <= reach_; ++dj) {
      if (j + dj >= 0 && j + dj < grid_.ny) join(row_at(j, k), row_at(j + dj, k - 1));
    }
  }

  void join(std::size_t row_a, std::size_t row_b) {
    std::size_t a = starts_[row_a];
    std::size_t b = starts_[row_b];
    while (a < starts_[row_a + 1] && b < starts_[row_b + 1]) {
      if (runs_[a].first < runs_[b].last + reach_ && runs_[b].first < runs_[a].last + reach_) {
        const auto [low, high] = std::minmax({root(a), root(b)});
        bodies_.join(low, high);
      }
      runs_[a].last < runs_[b].last ? ++a : ++b;
    }
  }

  model::Grid grid_;
  int reach_;
  std::vector<VoxelRun> runs_;
  std::vector<std::size_t> starts_;
  DisjointSets<> bodies_{0};
};

struct Body {
  long voxels = 0;
  bool near = false;    // some of it lies in the neighbourhood
  bool border = false;  // it reaches the volume's border
};

std::vector<Body> measured(Runs& runs, const model::Grid& g, const std::optional<Neighbourhood>& inside) {
  std::vector<Body> bodies(runs.size());
  runs.each([&](std::size_t r, const VoxelRun& run, int j, int k) {
    Body& body = bodies[runs.root(r)];
    body.voxels += run.last - run.first;
    body.border =
        body.border || j == 0 || k == 0 || j + 1 == g.ny || k + 1 == g.nz || run.first == 0 || run.last == g.nx;
    if (inside && !body.near) {
      const auto& [low, high] = *inside;
      body.near = g.x_mm(run.last - 1) >= low[0] && g.x_mm(run.first) <= high[0] && g.y_mm(j) >= low[1] &&
                  g.y_mm(j) <= high[1] && g.z_mm(k) >= low[2] && g.z_mm(k) <= high[2];
    }
  });
  return bodies;
}

int fill_cavities(model::Volume& volume, double level) {
  constexpr long resolved = 27;
  Runs voids(volume, level, false, 0);
  const std::vector<Body> cavities = measured(voids, volume.grid, {});
  const auto small = [&](const Body& body) { return body.voxels > 0 && body.voxels < resolved && !body.border; };
  voids.each([&](std::size_t r, const VoxelRun& run, int j, int k) {
    if (!small(cavities[voids.root(r)])) return;
    float* row = volume.slice(k) + std::ptrdiff_t{j} * volume.grid.nx;
    std::fill(row + run.first, row + run.last, std::nextafter(static_cast<float>(level), 1e30F));
  });
  return static_cast<int>(std::count_if(cavities.begin(), cavities.end(), small));
}

// Of every seventh voxel above half the level, those at a surface included.
double median_inside(const model::Volume& volume, double level) {
  std::vector<float> values;
  for (std::size_t i = 0; i < volume.values.size(); i += 7) {
    if (static_cast<double>(volume.values[i]) > 0.5 * level) values.push_back(volume.values[i]);
  }
  return values.empty() ? 0.0 : stats::median(std::move(values));
}

}  // namespace

Neighbourhood neighbourhood(const model::StretchedVolume& target, double margin_mm) {
  const model::Grid& g = target.volume.grid;
  const auto [low, high] = model::covered_box(target.volume, std::nextafter(0.5F, 0.0F));
  if (low[0] > high[0]) throw Error{Fault::data, "target: no voxel is covered by a half or more"};
  return {{g.x_mm(low[0]) - margin_mm, g.y_mm(low[1]) - margin_mm, g.z_mm(low[2]) / target.stretch_z - margin_mm},
          {g.x_mm(high[0]) + margin_mm, g.y_mm(high[1]) + margin_mm, g.z_mm(high[2]) / target.stretch_z + margin_mm}};
}

BodyCount keep_bodies(model::Volume& volume, double level, const BodyRules& rules) {
  const model::Grid& g = volume.grid;
  BodyCount count;
  count.inside = median_inside(volume, level);
  Runs runs(volume, level, true, 1);
  const std::vector<Body> bodies = measured(runs, g, rules.inside);
  const double voxel_mm3 = g.voxel_mm * g.voxel_mm * g.voxel_mm;
  const auto elsewhere = [&](const Body& body) { return rules.inside && !body.near; };
  long largest = 0;
  for (const Body& body : bodies) {
    if (!elsewhere(body)) largest = std::max(largest, body.voxels);
  }
  const double least_mm3 = rules.least_mm3.value_or(0.01 * static_cast<double>(largest) * voxel_mm3);
  const auto dropped = [&](const Body& body) {
    return elsewhere(body) || static_cast<double>(body.voxels) * voxel_mm3 < least_mm3;
  };
  for (const Body& body : bodies) {
    if (body.voxels == 0) continue;
    const double mm3 = static_cast<double>(body.voxels) * voxel_mm3;
    const bool drop = dropped(body);
    ++(drop ? count.dropped : count.kept);
    (drop ? count.dropped_mm3 : count.kept_mm3) += mm3;
    if (drop) count.largest_dropped_mm3 = std::max(count.largest_dropped_mm3, mm3);
  }
  runs.each([&](std::size_t r, const VoxelRun& run, int j, int k) {
    if (!dropped(bodies[runs.root(r)])) return;
    float* row = volume.slice(k) + std::ptrdiff_t{j} * g.nx;
    std::fill(row + run.first, row + run.last, 0.0F);
  });
  count.filled = fill_cavities(volume, level);
  return count;
}

Json to_json(const BodyCount& count) {
  return {{"kept", count.kept},
          {"kept_mm3", count.kept_mm3},
          {"dropped", count.dropped},
          {"dropped_mm3", count.dropped_mm3},
          {"largest_dropped_mm3", count.largest_dropped_mm3},
          {"cavities_filled", count.filled},
          {"median_inside", count.inside}};
}

std::vector<std::string> cut_sides(const model::Volume& volume, double level) {
  const model::Grid& g = volume.grid;
  const auto at_level = [&](float value) { return static_cast<double>(value) >= level; };
  const auto reaches = [&](int k) { return std::any_of(volume.slice(k), volume.slice(k + 1), at_level); };
  const auto side = [&] {  // the ring of the outermost voxels that are seen from all sides
    const double radius = 0.5 * (std::min(g.nx, g.ny) - 1) - 1;
    for (int k = 0; k < g.nz; ++k) {
      for (int j = 0; j < g.ny; ++j) {
        for (int i = 0; i < g.nx; ++i) {
          if (!at_level(volume.slice(k)[flat_index(j, g.nx, i)])) continue;
          if (std::hypot(i - 0.5 * (g.nx - 1), j - 0.5 * (g.ny - 1)) >= radius) return true;
        }
      }
    }
    return false;
  };
  std::vector<std::string> cut;
  if (reaches(g.nz - 1)) cut.emplace_back("top");
  if (reaches(0)) cut.emplace_back("bottom");
  if (side()) cut.emplace_back("side");
  return cut;
}

}  // namespace vam::metrology
