// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/rays_kernel.hpp"

#include "base/compute/kernel_vector.hpp"

namespace vam::light::VAM_SIMD {

using namespace vam::VAM_SIMD;

namespace {

using Ints = int __attribute__((vector_size(vector_floats * 4), may_alias, aligned(4)));

inline Vector lane_numbers() {
  Vector l{};
  for (int i = 0; i < vector_floats; ++i) l[i] = static_cast<float>(i);
  return l;
}

inline Ints whole(Vector x) { return __builtin_convertvector(x, Ints); }
inline Vector floats(Ints x) { return __builtin_convertvector(x, Vector); }
inline Vector positive(Vector x) { return x > 0.0F ? x : Vector{}; }
/// Without the bit of the sign: one instruction.
inline Vector size(Vector x) { return reinterpret_cast<Vector>(reinterpret_cast<Ints>(x) & 0x7FFFFFFF); }

/// Element index of (low, high) side by side; indices are taken modulo twice the vector's length.
inline Vector pick(Vector low, Vector high, Ints index) { return __builtin_shuffle(low, high, index); }

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
/// voxel_gap() zeros lie before and after `from`.
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

/// The weights of a ray's columns, in registers where their number is known: stores might change them in memory.
template <int taps>
struct Weights {
  const float* weight;
  long pitch;
  Vector held[taps > 0 ? taps : 1];

  Weights(const RayTaps& ray, int e) : weight(ray.weight + e), pitch(ray.pitch) {
    for (int k = 0; k < taps; ++k) held[k] = Vector{} + weight[k * pitch];
  }
  Vector operator[](int k) const {
    if (taps > 0) return held[k];
    return Vector{} + weight[k * pitch];
  }
};

/// taps: 3 to 6, the usual numbers, or 0 for any.
template <int width, bool climbs, bool shadowed, int taps>
void gather(const TileColumns& columns, const RayTaps& ray, const VoxelRay* rays, int count, float* voxels) {
  alignas(64) float line[most_tile_rows + 32];
  const int pitch = climbs ? columns.pitch : width;
  const int rows = climbs ? columns.rows : width;
  const int ends = taps > 0 ? taps : ray.taps;
  if (climbs) {
    for (int v = 0; v < 32; v += vector_floats) store(line + rows + v, Vector{});
  }
  for (int r = 0; r < count; ++r) {
    const int e = rays[r].ray;
    const float* light = columns.light + columns.first + static_cast<long>(ray.cell[e] - ray.first_cell) * pitch;
    const Weights<taps> weight(ray, e);
    float* to = voxels + static_cast<long>(rays[r].voxel) * (width + voxel_gap(climbs));
    float* sums = climbs ? line : to;
    for (int v = 0; v < rows; v += vector_floats) {
      Vector sum = climbs ? Vector{} : load(to + v);
#pragma GCC unroll 4
      for (int k = 0; k < ends; ++k) {
        const long at = static_cast<long>(k) * pitch + v;
        const long tap = static_cast<long>(k) * ray.pitch;
        const Vector here = load(light + at);
        if (shadowed) {
          const Vector ends_mm = load(columns.ends_mm + (light - columns.light) + at);
          sum += weight[k] * (ends_mm > columns.depth_mm[tap + e] ? here : Vector{});
        } else {
          sum += weight[k] * here;
        }
      }
      store(sums + v, sum);
    }
    if (climbs) take_rows<width>(line, ray.start[e] - ray.first_row, ray.zoom[e], to);
  }
}

template <int width, bool climbs, bool shadowed, int taps>
void scatter(const float* voxels, const RayTaps& ray, const VoxelRay* rays, int count, const TileColumns& columns) {
  alignas(64) float line[most_tile_rows + 32];
  const int pitch = climbs ? columns.pitch : width;
  const int rows = climbs ? columns.rows : width;
  const int ends = taps > 0 ? taps : ray.taps;
  for (int r = 0; r < count; ++r) {
    const int e = rays[r].ray;
    float* light = columns.light + columns.first + static_cast<long>(ray.cell[e] - ray.first_cell) * pitch;
    const Weights<taps> weight(ray, e);
    const float* from = voxels + static_cast<long>(rays[r].voxel) * (width + voxel_gap(climbs));
    if (climbs) give_rows(from, ray.start[e] - ray.first_row, ray.zoom[e], rows, line);
    const float* given = climbs ? line : from;
    for (int v = 0; v < rows; v += vector_floats) {
      const Vector value = load(given + v);
#pragma GCC unroll 4
      for (int k = 0; k < ends; ++k) {
        const long at = static_cast<long>(k) * pitch + v;
        const long tap = static_cast<long>(k) * ray.pitch;
        Vector share = weight[k] * value;
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
void gather_chunk(const TileColumns& columns, const RayTaps& taps, const VoxelRay* rays, int count, float* voxels) {
  if (columns.ends_mm != nullptr) return gather<width, climbs, true, 0>(columns, taps, rays, count, voxels);
  if (taps.taps == 3) return gather<width, climbs, false, 3>(columns, taps, rays, count, voxels);
  if (taps.taps == 4) return gather<width, climbs, false, 4>(columns, taps, rays, count, voxels);
  if (taps.taps == 5) return gather<width, climbs, false, 5>(columns, taps, rays, count, voxels);
  if (taps.taps == 6) return gather<width, climbs, false, 6>(columns, taps, rays, count, voxels);
  gather<width, climbs, false, 0>(columns, taps, rays, count, voxels);
}

template <int width, bool climbs>
void scatter_chunk(const float* voxels, const RayTaps& taps, const VoxelRay* rays, int count,
                   const TileColumns& columns) {
  if (columns.ends_mm != nullptr) return scatter<width, climbs, true, 0>(voxels, taps, rays, count, columns);
  if (taps.taps == 3) return scatter<width, climbs, false, 3>(voxels, taps, rays, count, columns);
  if (taps.taps == 4) return scatter<width, climbs, false, 4>(voxels, taps, rays, count, columns);
  if (taps.taps == 5) return scatter<width, climbs, false, 5>(voxels, taps, rays, count, columns);
  if (taps.taps == 6) return scatter<width, climbs, false, 6>(voxels, taps, rays, count, columns);
  scatter<width, climbs, false, 0>(voxels, taps, rays, count, columns);
}

}  // namespace

void gather_rays(const TileColumns& columns, const RayTaps& taps, const VoxelRay* rays, int count, int width,
                 bool climbs, float* voxels) {
  if (width == 64 && climbs) return gather_chunk<64, true>(columns, taps, rays, count, voxels);
  if (width == 64) return gather_chunk<64, false>(columns, taps, rays, count, voxels);
  if (width == 32 && climbs) return gather_chunk<32, true>(columns, taps, rays, count, voxels);
  if (width == 32) return gather_chunk<32, false>(columns, taps, rays, count, voxels);
  if (climbs) return gather_chunk<16, true>(columns, taps, rays, count, voxels);
  gather_chunk<16, false>(columns, taps, rays, count, voxels);
}

void scatter_rays(const float* voxels, const RayTaps& taps, const VoxelRay* rays, int count, int width, bool climbs,
                  const TileColumns& columns) {
  if (width == 64 && climbs) return scatter_chunk<64, true>(voxels, taps, rays, count, columns);
  if (width == 64) return scatter_chunk<64, false>(voxels, taps, rays, count, columns);
  if (width == 32 && climbs) return scatter_chunk<32, true>(voxels, taps, rays, count, columns);
  if (width == 32) return scatter_chunk<32, false>(voxels, taps, rays, count, columns);
  if (climbs) return scatter_chunk<16, true>(voxels, taps, rays, count, columns);
  scatter_chunk<16, false>(voxels, taps, rays, count, columns);
}

}  // namespace vam::light::VAM_SIMD
