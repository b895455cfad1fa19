#include "light/trace.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/simd.hpp"
#include "base/text.hpp"
#include "light/insert_shadow.hpp"
#include "light/trace_kernel.hpp"

namespace vam::light {

namespace {

using Index = std::ptrdiff_t;

constexpr double turn_rad = 2 * std::numbers::pi;
constexpr int tile_edge = 8;          // voxels; their light of one angle spans some 20 columns
constexpr int padding = 2;            // dark columns on either side of the projector
constexpr double rows_per_voxel = 2;  // of the table's radii

// Cache-line aligned floats, uninitialised.
struct Free {
  void operator()(float* p) const { ::operator delete (p, std::align_val_t{64}); }
};
using Floats = std::unique_ptr<float[], Free>;
Floats make_floats(Index count) {
  return Floats(
      static_cast<float*>(::operator new (static_cast<std::size_t>(count) * sizeof(float), std::align_val_t{64})));
}

struct Kernels {
  decltype(&baseline::trace_entries) entries;
  decltype(&baseline::trace_add_16) add;
};

Kernels kernels(int lanes) {
  const auto pick = [&](auto entries, auto a16, auto a32, auto a64) {
    return Kernels{entries, lanes == 16 ? a16 : lanes == 32 ? a32 : a64};
  };
#if defined(__x86_64__)
  if (simd_level() == Simd::avx512) {
    return pick(avx512::trace_entries, avx512::trace_add_16, avx512::trace_add_32, avx512::trace_add_64);
  }
  if (simd_level() == Simd::avx2) {
    return pick(avx2::trace_entries, avx2::trace_add_16, avx2::trace_add_32, avx2::trace_add_64);
  }
#endif
  return pick(baseline::trace_entries, baseline::trace_add_16, baseline::trace_add_32, baseline::trace_add_64);
}

// Symmetric weights {middle, first neighbours, ...} of a box whose variance, in columns, is `variance`: m whole columns
// on either side and a part e of the next, from variance (2 m + 1 + 2 e) = 2 (1 + 4 + ... + m^2) + 2 e (m + 1)^2.
std::vector<float> box_weights(double variance) {
  for (int m = 0;; ++m) {
    const double squares = m * (m + 1) * (2 * m + 1) / 3.0;
    const double next = (m + 1.0) * (m + 1.0);
    const double e = (variance * (2 * m + 1) - squares) / (2 * (next - variance));
    if (next <= variance || e > 1) continue;
    std::vector<float> weights(static_cast<std::size_t>(m + 2), static_cast<float>(1 / (2 * m + 1 + 2 * e)));
    weights.back() *= static_cast<float>(e);
    return weights;
  }
}

double farthest_mm(const model::Grid& grid) {
  const double x = std::max(std::abs(grid.x_mm(0)), std::abs(grid.x_mm(grid.nx - 1)));
  const double y = std::max(std::abs(grid.y_mm(0)), std::abs(grid.y_mm(grid.ny - 1)));
  return std::hypot(x, y);
}

int direction_sense(const TraceSetup& setup) { return (setup.turn.step_rad < 0 ? 1 : -1) * setup.direction; }

}  // namespace

struct Tracer::State {
  TraceSetup setup;
  LitTable table;
  std::vector<std::vector<float>> shadow;  // per column: box_weights of a voxel's shadow
  int stride = 0;                          // columns and padding

  explicit State(const TraceSetup& s)
      : setup(s),
        table(s.view, s.turn.rows, direction_sense(s), s.absorption_per_mm, farthest_mm(s.grid),
              s.grid.voxel_mm / rows_per_voxel),
        stride(s.projector.columns + 2 * padding) {
    for (int c = 0; c < s.projector.columns; ++c) {
      const optics::ChiefRay ray = optics::chief_ray(s.view, s.projector.x_mm(c));
      // A voxel's shadow has the variance voxel^2 / 12 from every side; in columns, that over their pitch in the resin.
      const double width = ray.hits ? s.grid.voxel_mm / (ray.jacobian * s.projector.pixel_mm) : 0;
      shadow.push_back(box_weights(width * width / 12));
    }
  }

  // What voxels take their light from.
  struct Lit {
    const float* slab;
    int lanes;
    const InsertShadow* rays;  // null without inserts
  };

  [[nodiscard]] InsertShadow all_rays() const;
  void fill_row(std::span<const Image> sinograms, int row, int lanes, float* to) const;
  void dose_tile(const Lit& lit, int tile, std::span<Image> doses) const;
  void trace_voxel(const Kernels& kernel, const LitTable::Zone& zone, int i, int j, const Lit& lit, int row, int rows,
                   float* dose) const;
  void add_unshadowed(const Lit& lit, const TraceEntries& entries, int count, int i, int j, float* dose) const;
};

// The rays of the padded columns at all stage angles.
InsertShadow Tracer::State::all_rays() const {
  std::vector<double> angles;
  for (int row = 0; row < setup.turn.rows; ++row) {
    angles.push_back(setup.direction * (setup.turn.start_rad + row * setup.turn.step_rad) + setup.angle_offset_rad);
  }
  std::vector<RayLine> lines;
  for (int c = -padding; c < setup.projector.columns + padding; ++c) {
    const int column = std::clamp(c, 0, setup.projector.columns - 1);  // beside the projector it is dark
    const optics::ChiefRay ray = optics::chief_ray(setup.view, setup.projector.x_mm(column));
    lines.push_back({ray.hits, ray.x_v_mm, ray.delta_rad});
  }
  return {setup.grid, angles, lines};
}

// One stage angle of the slab: [column][lane], each slice smoothed by the shadow of a voxel.
void Tracer::State::fill_row(std::span<const Image> sinograms, int row, int lanes, float* to) const {
  const int columns = setup.projector.columns;
  std::fill_n(to, Index{stride} * lanes, 0.0F);
  for (std::size_t s = 0; s < sinograms.size(); ++s) {
    const float* from = sinograms[s].row(row);
    float* lane = to + Index{padding} * lanes + static_cast<Index>(s);
    for (int c = 0; c < columns; ++c) {
      const std::vector<float>& weights = shadow[static_cast<std::size_t>(c)];
      float sum = weights[0] * from[c];
      for (int m = 1; m < static_cast<int>(weights.size()); ++m) {
        const float left = c >= m ? from[c - m] : 0.0F;
        const float right = c + m < columns ? from[c + m] : 0.0F;
        sum += weights[static_cast<std::size_t>(m)] * (left + right);
      }
      lane[Index{c} * lanes] = sum;
    }
  }
}

// Adds the light of those of the voxel's rays that have not yet met the insert.
void Tracer::State::add_unshadowed(const Lit& lit, const TraceEntries& entries, int count, int i, int j,
                                   float* dose) const {
  const double x = setup.grid.x_mm(i);
  const double y = setup.grid.y_mm(j);
  const InsertShadow& rays = *lit.rays;
  for (int e = 0; e < count; ++e) {
    const int row = entries.cell[e] / stride;
    const int column = entries.cell[e] % stride;
    const float* light = lit.slab + Index{entries.cell[e]} * lit.lanes;
    rays.add(row, column, rays.depth_mm(x, y, row, column), entries.left[e], light, dose);
    rays.add(row, column + 1, rays.depth_mm(x, y, row, column + 1), entries.right[e], light + lit.lanes, dose);
  }
}

// Adds the light of stage angles [row, row + rows) on a voxel of a zone.
void Tracer::State::trace_voxel(const Kernels& kernel, const LitTable::Zone& zone, int i, int j, const Lit& lit,
                                int row, int rows, float* dose) const {
  const double x = setup.grid.x_mm(i);
  const double y = setup.grid.y_mm(j);
  const double psi = std::atan2(y, x);
  const double place = (std::hypot(x, y) - zone.first_mm) / zone.pitch_mm;
  // alpha = psi - theta: the voxel seen from the lab. In steps of the table, increasing with the row.
  const double theta = setup.direction * setup.turn.start_rad + setup.angle_offset_rad;
  const int directions = table.angles * table.phases;
  double alpha = direction_sense(setup) * (psi - theta) / turn_rad;
  alpha = (alpha - std::floor(alpha)) * directions;
  const int index = std::min(static_cast<int>(alpha), directions - 1);
  const bool nearest = zone.sheets > 1;
  const int low = nearest ? std::clamp(static_cast<int>(std::lround(place)), 0, zone.rows - 1)
                          : std::clamp(static_cast<int>(place), 0, zone.rows - 2);
  TraceSource source{};
  source.radius_part = nearest ? 0.0F : static_cast<float>(place - low);
  source.direction_part = static_cast<float>(alpha - index);
  const TraceColumns columns{static_cast<float>(1 / setup.projector.pixel_mm),
                             static_cast<float>(setup.projector.axis_column + padding), static_cast<float>(stride - 2),
                             stride};
  TraceEntries entries;
  for (int sheet = 0; sheet < zone.sheets; ++sheet) {
    for (const int corner : {0, 1, 2, 3}) {
      const int at = index + corner % 2;
      const std::size_t series = table.series(zone, low + (nearest ? 0 : corner / 2), sheet, at % table.phases) +
                                 static_cast<std::size_t>(at / table.phases + row);
      source.x_p[corner] = zone.x_p_mm.data() + series;
      source.strength[corner] = zone.strength.data() + series;
    }
    kernel.entries(source, columns, row, rows, entries);
    int count = rows;
    if (nearest) {  // most directions of a fold have no ray
      count = 0;
      for (int e = 0; e < rows; ++e) {
        if (entries.left[e] == 0 && entries.right[e] == 0) continue;
        entries.cell[count] = entries.cell[e];
        entries.left[count] = entries.left[e];
        entries.right[count++] = entries.right[e];
      }
    }
    if (lit.rays == nullptr) {
      kernel.add(lit.slab, entries, count, dose);
    } else {
      add_unshadowed(lit, entries, count, i, j, dose);
    }
  }
}

void Tracer::State::dose_tile(const Lit& lit, int tile, std::span<Image> doses) const {
  const model::Grid& grid = setup.grid;
  const Kernels kernel = kernels(lit.lanes);
  const int tiles_x = (grid.nx + tile_edge - 1) / tile_edge;
  const int i0 = tile % tiles_x * tile_edge;
  const int j0 = tile / tiles_x * tile_edge;
  const int i1 = std::min(i0 + tile_edge, grid.nx);
  const int j1 = std::min(j0 + tile_edge, grid.ny);
  alignas(64) float sums[tile_edge * tile_edge * 64] = {};
  const auto sums_of = [&](int i, int j) {
    return sums + static_cast<std::ptrdiff_t>((j - j0) * tile_edge + (i - i0)) * lit.lanes;
  };
  // Angles outside, voxels inside: the light of a few angles on the tile stays in the cache.
  for (int row = 0; row < setup.turn.rows; row += trace_rows) {
    const int rows = std::min(trace_rows, setup.turn.rows - row);
    for (int j = j0; j < j1; ++j) {
      for (int i = i0; i < i1; ++i) {
        const double r = std::hypot(grid.x_mm(i), grid.y_mm(j));
        if (r >= table.edge_mm) continue;
        const bool outside = r >= table.reach_mm && table.outer.rows > 0;
        const LitTable::Zone& zone = outside ? table.outer : table.inner;
        trace_voxel(kernel, zone, i, j, lit, row, rows, sums_of(i, j));
      }
    }
  }
  const auto step = static_cast<float>(std::abs(setup.turn.step_rad));
  for (int j = j0; j < j1; ++j) {
    for (int i = i0; i < i1; ++i) {
      const float* sum = sums_of(i, j);
      for (std::size_t s = 0; s < doses.size(); ++s) doses[s](i, j) = step * sum[s];
    }
  }
}

Tracer::Tracer(const TraceSetup& setup) {
  const double covered = setup.turn.rows * std::abs(setup.turn.step_rad);
  if (setup.turn.rows < 1 || !(std::abs(covered - turn_rad) < 0.01 * std::abs(setup.turn.step_rad))) {
    throw Error{Fault::data, "sinogram: its " + std::to_string(setup.turn.rows) + " angles cover " +
                                 format_number(covered * deg_per_rad) + " deg; the dose needs exactly one turn"};
  }
  state_ = std::make_unique<State>(setup);
}

Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;

void Tracer::dose(std::span<const Image> sinograms, std::span<Image> doses, std::span<const Image> inserts) const {
  const State& state = *state_;
  const model::Grid& grid = state.setup.grid;
  const int rows = state.setup.turn.rows;
  const int columns = state.setup.projector.columns;
  for (const Image& image : sinograms) {
    if (image.width != columns || image.height != rows) {
      throw Error{Fault::data, "sinogram: a slice has " + std::to_string(image.width) + " x " +
                                   std::to_string(image.height) + " pixels, the projector " + std::to_string(columns) +
                                   " columns and the stack " + std::to_string(rows) + " angles"};
    }
  }
  std::optional<InsertShadow> rays;
  if (!inserts.empty()) rays = state.all_rays();
  const std::size_t most = rays ? InsertShadow::lanes : 64;
  for (std::size_t first = 0; first < sinograms.size(); first += most) {
    const std::size_t count = std::min(most, sinograms.size() - first);
    const int lanes = count <= 16 ? 16 : count <= 32 ? 32 : 64;
    const auto in = sinograms.subspan(first, count);
    const auto out = doses.subspan(first, count);
    for (Image& image : out) image = Image(grid.nx, grid.ny);
    const Index row_size = Index{state.stride} * lanes;
    const Floats slab = make_floats(row_size * rows);
    parallel_for(rows, [&](int row) { state.fill_row(in, row, lanes, slab.get() + row * row_size); });
    if (rays) rays->cast(inserts.subspan(first, count));
    const State::Lit lit{slab.get(), lanes, rays ? &*rays : nullptr};
    const int tiles = ((grid.nx + tile_edge - 1) / tile_edge) * ((grid.ny + tile_edge - 1) / tile_edge);
    parallel_for(tiles, [&](int tile) { state.dose_tile(lit, tile, out); });
    if (rays) darken(inserts.subspan(first, count), out);
  }
}

}  // namespace vam::light
