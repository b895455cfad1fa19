#include "light/private/ray_kernel.hpp"

#include "base/kernel_vector.hpp"

namespace vam::light::VAM_SIMD {

using namespace vam::VAM_SIMD;

namespace {

using Ints = int __attribute__((vector_size(vector_floats * 4), may_alias, aligned(4)));
using Node = float __attribute__((vector_size(32), may_alias, aligned(32)));

inline float positive(float x) { return x > 0.0F ? x : 0.0F; }
inline float size(float x) { return x > 0.0F ? x : -x; }

/// Square of what is positive: the integral of a ramp, twice.
inline float ramp(float x) {
  const float p = positive(x);
  return p * p;
}

inline Vector lane_numbers() {
  Vector l{};
  for (int i = 0; i < vector_floats; ++i) l[i] = static_cast<float>(i);
  return l;
}

inline Ints whole(Vector x) { return __builtin_convertvector(x, Ints); }
inline Vector floats(Ints x) { return __builtin_convertvector(x, Vector); }
inline Vector positive(Vector x) { return x > 0.0F ? x : Vector{}; }
inline Vector size(Vector x) { return x > 0.0F ? x : -x; }

/// Element index of (low, high) side by side; indices are taken modulo twice the vector's length.
inline Vector pick(Vector low, Vector high, Ints index) { return __builtin_shuffle(low, high, index); }

/// The node between four of them.
inline void find_node(const RayNode* nodes, const RaySource& source, const RayFrame& frame, Node& to) {
  int direction = source.direction + frame.shift;
  direction = direction < frame.directions ? direction : direction - frame.directions;
  const Node* low = reinterpret_cast<const Node*>(nodes + source.low_row + direction);
  const Node* high = reinterpret_cast<const Node*>(nodes + source.high_row + direction);
  __builtin_prefetch(low + frame.step);  // the next stage angle's
  __builtin_prefetch(high + frame.step);
  const Node a = low[0] + source.direction_part * (low[1] - low[0]);
  const Node b = high[0] + source.direction_part * (high[1] - high[0]);
  to = a + source.radius_part * (b - a);
}

/// Weights of the columns under the shadows of one block of voxels.
struct Shadows {
  alignas(64) float left[ray_block];   // of the shadow's middle: the edge before the first column
  alignas(64) float inner[ray_block];  // half the width of the trapezoid's top, and of its foot
  alignas(64) float outer[ray_block];
  alignas(64) float gain[ray_block];
};

inline void cast_shadows(const Node* at, const RayFrame& frame, int e, RayTaps& taps, Shadows& shadows) {
  for (int i = 0; i < ray_block; ++i) {
    const float cosine = at[i][5];
    const float sine = at[i][6];
    const float a = size(frame.cosine * cosine - frame.sine * sine);
    const float b = size(frame.sine * cosine + frame.cosine * sine);
    const float edge = at[i][4];
    const float wide = edge * (a > b ? a : b);
    const float thin = edge * (a > b ? b : a);
    const float narrow = thin > 0.02F * wide ? thin : 0.02F * wide;  // no quotient of nothing
    shadows.inner[i] = 0.5F * (wide - narrow);
    shadows.outer[i] = 0.5F * (wide + narrow);
    shadows.gain[i] = at[i][3] / (2.0F * wide * narrow);
    float column = at[i][0];
    column = column < 0.0F ? 0.0F : column;
    column = column > frame.last_column ? frame.last_column : column;
    const int first = static_cast<int>(positive(column - shadows.outer[i] + 0.5F));  // what lies before 0 is dark
    taps.cell[e + i] = first;
    shadows.left[i] = static_cast<float>(first) - 0.5F - column;
    taps.zoom[e + i] = at[i][2];
    taps.start[e + i] = at[i][1] - frame.half * at[i][2];
  }
}

inline void weigh(const Shadows& shadows, int e, const RayTaps& taps) {
  alignas(64) float up_to[ray_block] = {};
  for (int k = 0; k < taps.taps; ++k) {
    float* __restrict weights = taps.weight + static_cast<long>(k) * taps.pitch + e;
    for (int i = 0; i < ray_block; ++i) {
      const float edge = shadows.left[i] + static_cast<float>(k + 1);
      const float inner = shadows.inner[i];
      const float outer = shadows.outer[i];
      const float t = edge < outer ? edge : outer;
      const float sum = ramp(t + outer) - ramp(t + inner) - ramp(t - inner) + ramp(t - outer);
      weights[i] = shadows.gain[i] * (sum - up_to[i]);
      up_to[i] = sum;
    }
  }
}

/// What the rays of a tile have in common, ray by ray of a block.
struct Bounds {
  alignas(64) int first_cell[ray_block], last_cell[ray_block];
  alignas(64) float first_row[ray_block], last_row[ray_block], outer[ray_block];

  void begin(const RayTaps& taps) {
    for (int i = 0; i < ray_block; ++i) {
      first_cell[i] = last_cell[i] = taps.cell[i];
      first_row[i] = last_row[i] = taps.start[i];
      outer[i] = 0.0F;
    }
  }
  void add(const RayTaps& taps, const Shadows& shadows, float slices, int e) {
    for (int i = 0; i < ray_block; ++i) {
      const int cell = taps.cell[e + i];
      const float start = taps.start[e + i];
      const float end = start + slices * taps.zoom[e + i];
      first_cell[i] = cell < first_cell[i] ? cell : first_cell[i];
      last_cell[i] = cell > last_cell[i] ? cell : last_cell[i];
      first_row[i] = start < first_row[i] ? start : first_row[i];
      last_row[i] = end > last_row[i] ? end : last_row[i];
      outer[i] = shadows.outer[i] > outer[i] ? shadows.outer[i] : outer[i];
    }
  }
  void tell(int most_taps, RayTaps& taps) const {
    taps.first_cell = first_cell[0];
    taps.last_cell = last_cell[0];
    taps.first_row = first_row[0];
    taps.last_row = last_row[0];
    float widest = outer[0];
    for (int i = 1; i < ray_block; ++i) {
      taps.first_cell = first_cell[i] < taps.first_cell ? first_cell[i] : taps.first_cell;
      taps.last_cell = last_cell[i] > taps.last_cell ? last_cell[i] : taps.last_cell;
      taps.first_row = first_row[i] < taps.first_row ? first_row[i] : taps.first_row;
      taps.last_row = last_row[i] > taps.last_row ? last_row[i] : taps.last_row;
      widest = outer[i] > widest ? outer[i] : widest;
    }
    const int needed = static_cast<int>(2.0F * widest) + 2;
    taps.taps = needed < most_taps ? needed : most_taps;
  }
};

}  // namespace

void aim_rays(const RayNode* nodes, const RaySource* sources, int count, const RayFrame& frame, RayTaps& taps) {
  alignas(64) Node at[ray_block];
  Shadows shadows[most_blocks];
  Bounds bounds;
  for (int e = 0; e < count; e += ray_block) {
    Shadows& block = shadows[e / ray_block];
    for (int i = 0; i < ray_block; ++i) find_node(nodes, sources[e + i], frame, at[i]);
    cast_shadows(at, frame, e, taps, block);
    if (e == 0) bounds.begin(taps);
    bounds.add(taps, block, 2.0F * frame.half, e);
  }
  bounds.tell(frame.taps, taps);
  for (int e = 0; e < count; e += ray_block) weigh(shadows[e / ray_block], e, taps);
}

void copy_columns(const float* from, int columns, int count, int pitch, long next, float* to) {
  constexpr int slab = 16;
  if (count == slab) {
    for (int c = 0; c < columns; ++c, from += slab, to += pitch) {
      __builtin_prefetch(from + next);
      for (int v = 0; v < slab; v += vector_floats) store(to + v, load(from + v));
    }
    return;
  }
  for (int c = 0; c < columns; ++c, from += slab, to += pitch) {
    for (int i = 0; i < count; ++i) to[i] = from[i];
  }
}

void add_columns(const float* from, int columns, int count, int pitch, long next, float* to) {
  constexpr int slab = 16;
  if (count == slab) {
    for (int c = 0; c < columns; ++c, from += pitch, to += slab) {
      __builtin_prefetch(to + next, 1);
      for (int v = 0; v < slab; v += vector_floats) store(to + v, load(to + v) + load(from + v));
    }
    return;
  }
  for (int c = 0; c < columns; ++c, from += pitch, to += slab) {
    for (int i = 0; i < count; ++i) to[i] += from[i];
  }
}

namespace {

/// to[l] += line at row + zoom * l, linear between rows, l < width.
template <int width>
inline void take_rows(const float* line, float row, float zoom, float* to) {
  const Vector number = lane_numbers();
#pragma GCC unroll 4
  for (int first = 0; first < width; first += vector_floats) {
    const float start = row + zoom * static_cast<float>(first);
    const int base = static_cast<int>(start);
    const Vector place = (start - static_cast<float>(base)) + zoom * number;
    const Ints below = whole(place);
    const Vector part = place - floats(below);
    const Vector low = load(line + base);
    const Vector high = load(line + base + vector_floats);
    const Vector a = pick(low, high, below);
    store(to + first, load(to + first) + a + part * (pick(low, high, below + 1) - a));
  }
}

/// Its transpose, to rows [0, rows): of the slices less than a row away the first one, and the next one or two.
/// voxel_gap zeros lie before and after `from`.
inline void give_rows(const float* from, float row, float zoom, int rows, float* line) {
  const Vector number = lane_numbers();
  const float per_row = 1.0F / zoom;
  for (int base = 0; base < rows; base += vector_floats) {
    const float first = static_cast<float>(base) - 1.0F - row;      // where the first slice's row begins
    const int at = static_cast<int>(first * per_row + 64.0F) - 63;  // floor + 1
    const Vector before = number + first;
    const Ints slice = whole(before * per_row + 64.0F) - 63;
    const Vector away = zoom * floats(slice) - before - 1.0F;  // of the first slice, -1 to zoom - 1
    const Vector low = load(from + at);
    const Vector high = load(from + at + vector_floats);
    const Ints index = slice - at;
    Vector sum = (1.0F - size(away)) * pick(low, high, index);
    if (zoom > 1.0F) {
      sum += positive(1.0F - zoom - away) * pick(low, high, index + 1);
    } else {
      sum += (1.0F - size(away + zoom)) * pick(low, high, index + 1);
      sum += positive(1.0F - 2.0F * zoom - away) * pick(low, high, index + 2);
    }
    store(line + base, sum);
  }
}

/// taps: 3 or 4, the usual numbers, or 0 for any.
template <int width, bool climbs, bool shadowed, int taps>
void gather(const TileColumns& columns, const RayTaps& ray, const int* voxel, int count, float* voxels) {
  alignas(64) float line[most_tile_rows + 32];
  const int rows = climbs ? columns.rows : width;
  const int ends = taps > 0 ? taps : ray.taps;
  if (climbs) {
    for (int v = 0; v < 32; v += vector_floats) store(line + rows + v, Vector{});
  }
  for (int e = 0; e < count; ++e) {
    const float* light = columns.light + static_cast<long>(ray.cell[e] - ray.first_cell) * rows;
    const float* weight = ray.weight + e;
    float* to = voxels + static_cast<long>(voxel[e]) * (width + voxel_gap);
    float* sums = climbs ? line : to;
    for (int v = 0; v < rows; v += vector_floats) {
      Vector sum = climbs ? Vector{} : load(to + v);
#pragma GCC unroll 4
      for (int k = 0; k < ends; ++k) {
        const long at = static_cast<long>(k) * rows + v;
        const long tap = static_cast<long>(k) * ray.pitch;
        const Vector here = load(light + at);
        if (shadowed) {
          const Vector ends_mm = load(columns.ends_mm + (light - columns.light) + at);
          sum += weight[tap] * (ends_mm > columns.depth_mm[tap + e] ? here : Vector{});
        } else {
          sum += weight[tap] * here;
        }
      }
      store(sums + v, sum);
    }
    if (climbs) take_rows<width>(line, ray.start[e] - ray.first_row, ray.zoom[e], to);
  }
}

template <int width, bool climbs, bool shadowed, int taps>
void scatter(const float* voxels, const RayTaps& ray, const int* voxel, int count, const TileColumns& columns) {
  alignas(64) float line[most_tile_rows + 32];
  const int rows = climbs ? columns.rows : width;
  const int ends = taps > 0 ? taps : ray.taps;
  for (int e = 0; e < count; ++e) {
    float* light = columns.light + static_cast<long>(ray.cell[e] - ray.first_cell) * rows;
    const float* weight = ray.weight + e;
    const float* from = voxels + static_cast<long>(voxel[e]) * (width + voxel_gap);
    if (climbs) give_rows(from, ray.start[e] - ray.first_row, ray.zoom[e], rows, line);
    const float* given = climbs ? line : from;
    for (int v = 0; v < rows; v += vector_floats) {
      const Vector value = load(given + v);
#pragma GCC unroll 4
      for (int k = 0; k < ends; ++k) {
        const long at = static_cast<long>(k) * rows + v;
        const long tap = static_cast<long>(k) * ray.pitch;
        Vector share = weight[tap] * value;
        if (shadowed) {
          const Vector ends_mm = load(columns.ends_mm + (light - columns.light) + at);
          share = ends_mm > columns.depth_mm[tap + e] ? share : Vector{};
        }
        store(light + at, load(light + at) + share);
      }
    }
  }
}

template <int width, bool climbs>
void gather_chunk(const TileColumns& columns, const RayTaps& taps, const int* voxel, int count, float* voxels) {
  if (columns.ends_mm != nullptr) return gather<width, climbs, true, 0>(columns, taps, voxel, count, voxels);
  if (taps.taps == 3) return gather<width, climbs, false, 3>(columns, taps, voxel, count, voxels);
  if (taps.taps == 4) return gather<width, climbs, false, 4>(columns, taps, voxel, count, voxels);
  gather<width, climbs, false, 0>(columns, taps, voxel, count, voxels);
}

template <int width, bool climbs>
void scatter_chunk(const float* voxels, const RayTaps& taps, const int* voxel, int count, const TileColumns& columns) {
  if (columns.ends_mm != nullptr) return scatter<width, climbs, true, 0>(voxels, taps, voxel, count, columns);
  if (taps.taps == 3) return scatter<width, climbs, false, 3>(voxels, taps, voxel, count, columns);
  if (taps.taps == 4) return scatter<width, climbs, false, 4>(voxels, taps, voxel, count, columns);
  scatter<width, climbs, false, 0>(voxels, taps, voxel, count, columns);
}

}  // namespace

void gather_rays(const TileColumns& columns, const RayTaps& taps, const int* voxel, int count, int width, bool climbs,
                 float* voxels) {
  if (width == 64 && climbs) return gather_chunk<64, true>(columns, taps, voxel, count, voxels);
  if (width == 64) return gather_chunk<64, false>(columns, taps, voxel, count, voxels);
  if (width == 32 && climbs) return gather_chunk<32, true>(columns, taps, voxel, count, voxels);
  if (width == 32) return gather_chunk<32, false>(columns, taps, voxel, count, voxels);
  if (climbs) return gather_chunk<16, true>(columns, taps, voxel, count, voxels);
  gather_chunk<16, false>(columns, taps, voxel, count, voxels);
}

void scatter_rays(const float* voxels, const RayTaps& taps, const int* voxel, int count, int width, bool climbs,
                  const TileColumns& columns) {
  if (width == 64 && climbs) return scatter_chunk<64, true>(voxels, taps, voxel, count, columns);
  if (width == 64) return scatter_chunk<64, false>(voxels, taps, voxel, count, columns);
  if (width == 32 && climbs) return scatter_chunk<32, true>(voxels, taps, voxel, count, columns);
  if (width == 32) return scatter_chunk<32, false>(voxels, taps, voxel, count, columns);
  if (climbs) return scatter_chunk<16, true>(voxels, taps, voxel, count, columns);
  scatter_chunk<16, false>(voxels, taps, voxel, count, columns);
}

}  // namespace vam::light::VAM_SIMD
