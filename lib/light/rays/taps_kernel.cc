// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/rays/private/taps_kernel.hpp"

#include "tomo/footprint.hpp"

namespace vam::light::VAM_SIMD {

namespace {

using Node = float __attribute__((vector_size(32), may_alias, aligned(32)));

inline float positive(float x) { return x > 0.0F ? x : 0.0F; }
inline float size(float x) { return x > 0.0F ? x : -x; }

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
  alignas(64) float first_edge[ray_block];  // of the shadow's middle: the edge before the first column
  alignas(64) float half[ray_block];        // as those of tomo::Trapezoid
  alignas(64) float flat[ray_block];
  alignas(64) float slope[ray_block];
  alignas(64) float curve[ray_block];
  alignas(64) float before[ray_block];  // area up to the last edge that was taken
};

/// A trapezoid, box(wide) * box(thin), widened by a box: that of two boxes with their variance, the wider of the three
/// and another, or two alike where none is as wide as the others together.
inline void widen(float spread2, float& wide, float& thin) {
  const float wide2 = wide * wide;
  const float thin2 = thin * thin;
  const float most = spread2 > wide2 ? spread2 : wide2;
  const float rest = thin2 + (spread2 > wide2 ? wide2 : spread2);
  const float mean = 0.5F * (most + rest);
  wide = __builtin_sqrtf(most > mean ? most : mean);
  thin = __builtin_sqrtf(most > mean ? rest : mean);
}

template <bool spreads>
inline void cast_shadows(const Node* at, const RayFrame& frame, int e, RayTaps& taps, Shadows& shadows) {
  for (int i = 0; i < ray_block; ++i) {
    const float cosine = at[i][5];
    const float sine = at[i][6];
    const float a = size(frame.cosine * cosine - frame.sine * sine);
    const float b = size(frame.sine * cosine + frame.cosine * sine);
    const float edge = at[i][4];
    float wide = edge * (a > b ? a : b);
    float thin = edge * (a > b ? b : a);
    if (spreads) widen(at[i][7], wide, thin);
    const auto shadow = tomo::Trapezoid::of(wide, thin, at[i][3]);
    shadows.half[i] = shadow.half;
    shadows.flat[i] = shadow.flat;
    shadows.slope[i] = shadow.slope;
    shadows.curve[i] = shadow.curve;
    shadows.before[i] = -0.5F * at[i][3];
    float column = at[i][0];
    column = column < 0.0F ? 0.0F : column;
    column = column > frame.last_column ? frame.last_column : column;
    const int first = static_cast<int>(positive(column - shadow.half + 0.5F));  // what lies before 0 is dark
    taps.cell[e + i] = first;
    shadows.first_edge[i] = static_cast<float>(first) - 0.5F - column;
    taps.zoom[e + i] = at[i][2];
    taps.start[e + i] = at[i][1] - frame.half * at[i][2];
  }
}

inline void weigh(Shadows& shadows, int e, const RayTaps& taps) {
  for (int k = 0; k < taps.taps; ++k) {
    float* __restrict weights = taps.weight + static_cast<long>(k) * taps.pitch + e;
    for (int i = 0; i < ray_block; ++i) {
      const tomo::Trapezoid shadow{shadows.half[i], shadows.flat[i], shadows.slope[i], shadows.curve[i]};
      const float up_to = shadow.area_up_to(shadows.first_edge[i] + static_cast<float>(k + 1));
      const float share = up_to - shadows.before[i];
      weights[i] = share > 0.0F ? share : 0.0F;  // what rounding leaves beyond the shadow is no light
      shadows.before[i] = up_to;
    }
  }
}

/// What the rays of a tile have in common, ray by ray of a block.
struct TapBounds {
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
      outer[i] = shadows.half[i] > outer[i] ? shadows.half[i] : outer[i];
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

void find_taps(const RayNode* nodes, const RaySource* sources, int count, const RayFrame& frame, RayTaps& taps) {
  alignas(64) Node at[ray_block];
  Shadows shadows[most_blocks];
  TapBounds bounds{};
  for (int e = 0; e < count; e += ray_block) {
    Shadows& block = shadows[e / ray_block];
    for (int i = 0; i < ray_block; ++i) find_node(nodes, sources[e + i], frame, at[i]);
    frame.spreads ? cast_shadows<true>(at, frame, e, taps, block) : cast_shadows<false>(at, frame, e, taps, block);
    if (e == 0) bounds.begin(taps);
    bounds.add(taps, block, 2.0F * frame.half, e);
  }
  bounds.tell(frame.taps, taps);
  for (int e = 0; e < count; e += ray_block) weigh(shadows[e / ray_block], e, taps);
}

}  // namespace vam::light::VAM_SIMD
