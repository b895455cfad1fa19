#include "light/ray_kernel.hpp"

#include "base/kernel_vector.hpp"

namespace vam::light::VAM_SIMD {

using namespace vam::VAM_SIMD;

namespace {

using Ints = int __attribute__((vector_size(vector_floats * 4), may_alias, aligned(4)));

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

/// Element index of (low, high) side by side; indices are taken modulo twice the vector's length.
inline Vector pick(Vector low, Vector high, Ints index) { return __builtin_shuffle(low, high, index); }

}  // namespace

void ray_taps(const TapNodes& nodes, const TapSource& source, const TapFrame& frame, Taps& __restrict taps) {
  float* __restrict weights = taps.weight;
  const float both = source.radius_part * source.direction_part;
  const float w0 = 1.0F - source.radius_part - source.direction_part + both;
  const float w1 = source.direction_part - both;
  const float w2 = source.radius_part - both;
  const auto mean = [&](const float* values, int i) {
    return w0 * values[source.corner[0] + i] + w1 * values[source.corner[1] + i] + w2 * values[source.corner[2] + i] +
           both * values[source.corner[3] + i];
  };
  alignas(64) float up_to[tap_angles];
  alignas(64) float inner[tap_angles];
  alignas(64) float outer[tap_angles];
  alignas(64) float gain[tap_angles];
  alignas(64) float left[tap_angles];  // of the shadow's middle: the edge before the first column
  if (nodes.z_p_mm != nullptr) {
    for (int i = 0; i < tap_angles; ++i) {
      taps.row[i] = frame.rows_per_mm * mean(nodes.z_p_mm, i) + frame.row_origin;
      taps.zoom[i] = frame.slice_rows * mean(nodes.zoom, i);
    }
  } else {
    for (int i = 0; i < tap_angles; ++i) {
      taps.row[i] = 0.0F;
      taps.zoom[i] = 1.0F;
    }
  }
  for (int i = 0; i < tap_angles; ++i) {
    const float strength = mean(nodes.strength, i);
    const float cosine = nodes.cosine[source.corner[0] + i];
    const float sine = nodes.sine[source.corner[0] + i];
    const float a = size(frame.cosine[i] * cosine - frame.sine[i] * sine);
    const float b = size(frame.sine[i] * cosine + frame.cosine[i] * sine);
    const float edge = frame.voxel_columns * nodes.spacing[source.corner[0] + i];
    const float wide = edge * (a > b ? a : b);
    const float thin = edge * (a > b ? b : a);
    const float narrow = thin > 0.02F * wide ? thin : 0.02F * wide;  // no quotient of nothing
    inner[i] = 0.5F * (wide - narrow);
    outer[i] = 0.5F * (wide + narrow);
    gain[i] = strength / (2.0F * wide * narrow);
    float column = frame.columns_per_mm * mean(nodes.x_p_mm, i) + frame.column_origin;
    column = column < 0.0F ? 0.0F : column;
    column = column > frame.last_column ? frame.last_column : column;
    const float start = column - outer[i] + 0.5F;
    const int first = static_cast<int>(positive(start));  // never negative: what lies before is dark
    taps.cell[i] = first;
    left[i] = static_cast<float>(first) - 0.5F - column;
    up_to[i] = 0.0F;
  }
  float widest = 0.0F;
  for (int i = 0; i < tap_angles; ++i) widest = outer[i] > widest ? outer[i] : widest;
  const int needed = static_cast<int>(2.0F * widest) + 2;
  taps.taps = needed < frame.taps ? needed : frame.taps;
  for (int k = 0; k < taps.taps; ++k) {
    for (int i = 0; i < tap_angles; ++i) {
      const float edge = left[i] + static_cast<float>(k + 1);
      const float t = edge < outer[i] ? edge : outer[i];
      const float sum = ramp(t + outer[i]) - ramp(t + inner[i]) - ramp(t - inner[i]) + ramp(t - outer[i]);
      weights[k * tap_angles + i] = gain[i] * (sum - up_to[i]);
      up_to[i] = sum;
    }
  }
}

void range_of(const Taps* taps, int count, float outer, TapRange& __restrict range) {
  alignas(64) float low[tap_angles];
  alignas(64) float high[tap_angles];
  for (int i = 0; i < tap_angles; ++i) {
    range.first[i] = range.last[i] = taps[0].cell[i];
    range.low_row[i] = range.high_row[i] = taps[0].row[i];
    range.low_zoom[i] = range.high_zoom[i] = taps[0].zoom[i];
    low[i] = high[i] = taps[0].row[i] + taps[0].zoom[i] * outer;
  }
  for (int e = 1; e < count; ++e) {
    for (int i = 0; i < tap_angles; ++i) {
      const int cell = taps[e].cell[i];
      const float row = taps[e].row[i];
      const float zoom = taps[e].zoom[i];
      const float place = row + zoom * outer;
      range.first[i] = cell < range.first[i] ? cell : range.first[i];
      range.last[i] = cell > range.last[i] ? cell : range.last[i];
      range.low_row[i] = place < low[i] ? row : range.low_row[i];
      range.low_zoom[i] = place < low[i] ? zoom : range.low_zoom[i];
      low[i] = place < low[i] ? place : low[i];
      range.high_row[i] = place > high[i] ? row : range.high_row[i];
      range.high_zoom[i] = place > high[i] ? zoom : range.high_zoom[i];
      high[i] = place > high[i] ? place : high[i];
    }
  }
}

void split_taps(const Taps& taps, int columns, int planes, float outer, const TapRange& range,
                PlaneTaps& __restrict split) {
  alignas(64) float part[tap_angles];
  for (int i = 0; i < tap_angles; ++i) {
    const float low = range.low_row[i] + range.low_zoom[i] * outer;
    const float length = range.high_row[i] + range.high_zoom[i] * outer - low;
    const float here = taps.row[i] + taps.zoom[i] * outer - low;
    part[i] = length > 0.0F ? here / length : 0.0F;
    split.cell[i] = taps.cell[i] - range.first[i];
  }
  split.taps = columns;
  float* __restrict first = split.weight[0];
  float* __restrict second = split.weight[1];
  const float* from = taps.weight;
  for (int k = 0; k < columns; ++k) {
    for (int i = 0; i < tap_angles; ++i) {
      const float weight = from[k * tap_angles + i];
      const float above = planes == 2 ? part[i] * weight : 0.0F;
      first[k * tap_angles + i] = weight - above;
      second[k * tap_angles + i] = above;
    }
  }
}

void take_rows(const float* line, float row, float zoom, int width, float* to) {
  const Vector number = lane_numbers();
  for (int first = 0; first < width; first += vector_floats) {
    const float start = row + zoom * static_cast<float>(first);
    const int base = static_cast<int>(start);
    const Vector place = (start - static_cast<float>(base)) + zoom * number;
    const Ints below = whole(place);
    const Vector part = place - floats(below);
    const Vector low = load(line + base);
    const Vector high = load(line + base + vector_floats);
    const Vector a = pick(low, high, below);
    store(to + first, a + part * (pick(low, high, below + 1) - a));
  }
}

void give_rows(const float* from, float row, float zoom, int width, float* line) {
  const Vector number = lane_numbers();
  const float per_row = 1.0F / zoom;
  const Vector nothing{};
  const int hats = zoom > 1.0F ? 2 : 3;
  const int first = static_cast<int>(row);
  const int last = static_cast<int>(row + zoom * static_cast<float>(width - 1)) + 1;
  for (int base = first; base <= last; base += vector_floats) {
    const Vector here = number + static_cast<float>(base);
    // The slices whose hat of one row on either side covers a row: after the last one that ends before it, 2 where
    // slices are farther apart than rows, else 3.
    const Vector before = (here - 1.0F - row) * per_row;
    Ints slice = whole(before + 2.0F) - 1;  // floor + 1; before is never below -2
    const int low_slice = slice[0];
    const int start = low_slice < 0 ? 0 : low_slice > width - 1 ? width - 1 : low_slice;
    const int most = width - 2 * vector_floats;
    const int at = start < most ? start : most > 0 ? most : 0;
    const Vector low = load(from + at);
    const Vector high = width >= 2 * vector_floats ? load(from + at + vector_floats) : nothing;
    Vector sum{};
    for (int k = 0; k < hats; ++k, ++slice) {
      const Vector away = row + zoom * floats(slice) - here;
      Vector hat = 1.0F - (away > 0.0F ? away : -away);
      const Ints inside = (slice >= 0) & (slice < width);
      hat = hat > 0.0F ? hat : nothing;
      hat = inside ? hat : nothing;
      sum += hat * pick(low, high, slice - at);
    }
    float* to = line + base;
    store(to, load(to) + sum);
  }
}

namespace {

template <int width, int planes>
inline void gather(const float* light, const PlaneTaps& at, int angle, float* voxel) {
  const int taps = at.taps;
  constexpr int vectors = width / vector_floats;
  constexpr int together = vectors < 8 ? vectors : 8;  // sums that fit into half the registers
  const float* begin = light + static_cast<long>(at.cell[angle]) * planes * width;
  for (int first = 0; first < width; first += together * vector_floats) {
    Vector sum[together];
#pragma GCC unroll 8
    for (int v = 0; v < together; ++v) sum[v] = load(voxel + first + v * vector_floats);
    const float* column = begin + first;
    for (int k = 0; k < taps; ++k) {
#pragma GCC unroll 2
      for (int p = 0; p < planes; ++p, column += width) {
        const float weight = at.weight[p][k * tap_angles + angle];
#pragma GCC unroll 8
        for (int v = 0; v < together; ++v) sum[v] += weight * load(column + v * vector_floats);
      }
    }
#pragma GCC unroll 8
    for (int v = 0; v < together; ++v) store(voxel + first + v * vector_floats, sum[v]);
  }
}

template <int width, int planes>
inline void scatter(const float* voxel, const PlaneTaps& at, int angle, float* light) {
  const int taps = at.taps;
  constexpr int vectors = width / vector_floats;
  constexpr int together = vectors < 8 ? vectors : 8;
  float* begin = light + static_cast<long>(at.cell[angle]) * planes * width;
  for (int first = 0; first < width; first += together * vector_floats) {
    Vector value[together];
#pragma GCC unroll 8
    for (int v = 0; v < together; ++v) value[v] = load(voxel + first + v * vector_floats);
    float* column = begin + first;
    for (int k = 0; k < taps; ++k) {
#pragma GCC unroll 2
      for (int p = 0; p < planes; ++p, column += width) {
        const float weight = at.weight[p][k * tap_angles + angle];
#pragma GCC unroll 8
        for (int v = 0; v < together; ++v) {
          float* to = column + v * vector_floats;
          store(to, load(to) + weight * value[v]);
        }
      }
    }
  }
}

}  // namespace

namespace {

template <int width, int planes>
void gather_all(const float* light, const PlaneTaps* at, const int* voxel, int count, int angle, float* voxels) {
  for (int e = 0; e < count; ++e) gather<width, planes>(light, at[e], angle, voxels + voxel[e] * width);
}

template <int width, int planes>
void scatter_all(const float* voxels, const PlaneTaps* at, const int* voxel, int count, int angle, float* light) {
  for (int e = 0; e < count; ++e) scatter<width, planes>(voxels + voxel[e] * width, at[e], angle, light);
}

}  // namespace

void gather_rays(const float* light, int width, int planes, const PlaneTaps* at, const int* voxel, int count, int angle,
                 float* voxels) {
  if (planes == 2) {
    if (width == 64) return gather_all<64, 2>(light, at, voxel, count, angle, voxels);
    if (width == 32) return gather_all<32, 2>(light, at, voxel, count, angle, voxels);
    return gather_all<16, 2>(light, at, voxel, count, angle, voxels);
  }
  if (width == 64) return gather_all<64, 1>(light, at, voxel, count, angle, voxels);
  if (width == 32) return gather_all<32, 1>(light, at, voxel, count, angle, voxels);
  gather_all<16, 1>(light, at, voxel, count, angle, voxels);
}

void scatter_rays(const float* voxels, int width, int planes, const PlaneTaps* at, const int* voxel, int count,
                  int angle, float* light) {
  if (planes == 2) {
    if (width == 64) return scatter_all<64, 2>(voxels, at, voxel, count, angle, light);
    if (width == 32) return scatter_all<32, 2>(voxels, at, voxel, count, angle, light);
    return scatter_all<16, 2>(voxels, at, voxel, count, angle, light);
  }
  if (width == 64) return scatter_all<64, 1>(voxels, at, voxel, count, angle, light);
  if (width == 32) return scatter_all<32, 1>(voxels, at, voxel, count, angle, light);
  scatter_all<16, 1>(voxels, at, voxel, count, angle, light);
}

}  // namespace vam::light::VAM_SIMD
