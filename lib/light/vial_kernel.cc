#include "light/vial_kernel.hpp"

#include "base/kernel_vector.hpp"
#include "base/slab_lanes.hpp"

namespace vam::light::VAM_SIMD {

using namespace vam::VAM_SIMD;

void vial_taps(const VialSource& source, const VialColumns& columns, int rows, VialTaps& __restrict taps) {
  const float both = source.radius_part * source.direction_part;
  const float weight[4] = {1.0F - source.radius_part - source.direction_part + both, source.direction_part - both,
                           source.radius_part - both, both};
  const float* const* x = source.x_p_mm;
  const float* const* s = source.strength;
  for (int i = 0; i < rows; ++i) {
    const float x_p = weight[0] * x[0][i] + weight[1] * x[1][i] + weight[2] * x[2][i] + weight[3] * x[3][i];
    const float strength = weight[0] * s[0][i] + weight[1] * s[1][i] + weight[2] * s[2][i] + weight[3] * s[3][i];
    float column = columns.scale * x_p + columns.origin;
    column = column < 0.0F ? 0.0F : column;
    column = column > columns.last ? columns.last : column;
    const int cell = static_cast<int>(column);
    const float right = strength * (column - static_cast<float>(cell));
    taps.cell[i] = i * columns.stride + cell;
    taps.left[i] = strength - right;
    taps.right[i] = right;
  }
}

namespace {

constexpr int slab_vectors = lanes / vector_floats;

template <int width>
inline void gather(const float* light, const VialTaps& taps, int rows, float* voxel) {
  constexpr int vectors = width / vector_floats;
  constexpr int together = vectors < 8 ? vectors : 8;  // sums that fit into half the registers
  for (int first = 0; first < width; first += together * vector_floats) {
    Vector sum[together];
#pragma GCC unroll 8
    for (int v = 0; v < together; ++v) sum[v] = load(voxel + first + v * vector_floats);
    for (int i = 0; i < rows; ++i) {
      const float* at = light + static_cast<long>(taps.cell[i]) * width + first;
      const float left = taps.left[i];
      const float right = taps.right[i];
#pragma GCC unroll 8
      for (int v = 0; v < together; ++v) {
        sum[v] += left * load(at + v * vector_floats) + right * load(at + width + v * vector_floats);
      }
    }
#pragma GCC unroll 8
    for (int v = 0; v < together; ++v) store(voxel + first + v * vector_floats, sum[v]);
  }
}

template <int width>
inline void scatter(const float* voxel, const VialTaps& taps, int rows, float* light) {
  constexpr int vectors = width / vector_floats;
  constexpr int together = vectors < 8 ? vectors : 8;
  for (int first = 0; first < width; first += together * vector_floats) {
    Vector value[together];
#pragma GCC unroll 8
    for (int v = 0; v < together; ++v) value[v] = load(voxel + first + v * vector_floats);
    for (int i = 0; i < rows; ++i) {
      float* at = light + static_cast<long>(taps.cell[i]) * width + first;
      const float left = taps.left[i];
      const float right = taps.right[i];
#pragma GCC unroll 8
      for (int v = 0; v < together; ++v) {
        float* to = at + v * vector_floats;
        store(to, load(to) + left * value[v]);
        store(to + width, load(to + width) + right * value[v]);
      }
    }
  }
}

}  // namespace

void vial_gather(const float* light, int width, const VialTaps& taps, int rows, float* voxel) {
  if (width == 4 * lanes) return gather<4 * lanes>(light, taps, rows, voxel);
  if (width == 2 * lanes) return gather<2 * lanes>(light, taps, rows, voxel);
  gather<lanes>(light, taps, rows, voxel);
}

void vial_scatter(const float* voxel, int width, const VialTaps& taps, int rows, float* light) {
  if (width == 4 * lanes) return scatter<4 * lanes>(voxel, taps, rows, light);
  if (width == 2 * lanes) return scatter<2 * lanes>(voxel, taps, rows, light);
  scatter<lanes>(voxel, taps, rows, light);
}

void vial_blend(const float* from, long from_step, const float* weights, int count, float* to) {
  for (int v = 0; v < slab_vectors; ++v) {
    Vector sum = load(to + v * vector_floats);
    for (int k = 0; k < count; ++k) sum += weights[k] * load(from + k * from_step + v * vector_floats);
    store(to + v * vector_floats, sum);
  }
}

void vial_spread(const float* from, const float* weights, int count, long to_step, float* to) {
  for (int k = 0; k < count; ++k) {
    for (int v = 0; v < slab_vectors; ++v) {
      float* at = to + k * to_step + v * vector_floats;
      store(at, load(at) + weights[k] * load(from + v * vector_floats));
    }
  }
}

}  // namespace vam::light::VAM_SIMD
