#include "light/trace_kernel.hpp"

#include "base/kernel_vector.hpp"

namespace vam::light::VAM_SIMD {

using namespace vam::VAM_SIMD;

void trace_entries(const TraceSource& source, const TraceColumns& columns, int row, int rows,
                   TraceEntries& __restrict entries) {
  const float w3 = source.radius_part * source.direction_part;
  const float w2 = source.radius_part - w3;
  const float w1 = source.direction_part - w3;
  const float w0 = 1.0F - source.radius_part - source.direction_part + w3;
  const float* x0 = source.x_p[0];
  const float* x1 = source.x_p[1];
  const float* x2 = source.x_p[2];
  const float* x3 = source.x_p[3];
  const float* s0 = source.strength[0];
  const float* s1 = source.strength[1];
  const float* s2 = source.strength[2];
  const float* s3 = source.strength[3];
  for (int i = 0; i < rows; ++i) {
    const float x_p = w0 * x0[i] + w1 * x1[i] + w2 * x2[i] + w3 * x3[i];
    const float strength = w0 * s0[i] + w1 * s1[i] + w2 * s2[i] + w3 * s3[i];
    float column = columns.scale * x_p + columns.origin;
    column = column < 0.0F ? 0.0F : column;
    column = column > columns.last ? columns.last : column;
    const int cell = static_cast<int>(column);
    const float right = strength * (column - static_cast<float>(cell));
    entries.cell[i] = (row + i) * columns.stride + cell;
    entries.left[i] = strength - right;
    entries.right[i] = right;
  }
}

namespace {

template <int lanes>
inline void add(const float* slab, const TraceEntries& entries, int rows, float* dose) {
  constexpr int vectors = lanes / vector_floats;
  // As many sums as fit into half the registers; more lanes take another turn.
  constexpr int together = vectors < 8 ? vectors : 8;
  for (int first = 0; first < vectors; first += together) {
    Vector sum[together];
#pragma GCC unroll 8
    for (int v = 0; v < together; ++v) sum[v] = load(dose + (first + v) * vector_floats);
    const float* begin = slab + first * vector_floats;
    for (int i = 0; i < rows; ++i) {
      const float* at = begin + static_cast<long>(entries.cell[i]) * lanes;
      const float left = entries.left[i];
      const float right = entries.right[i];
#pragma GCC unroll 8
      for (int v = 0; v < together; ++v) {
        sum[v] += left * load(at + v * vector_floats);
        sum[v] += right * load(at + lanes + v * vector_floats);
      }
    }
#pragma GCC unroll 8
    for (int v = 0; v < together; ++v) store(dose + (first + v) * vector_floats, sum[v]);
  }
}

}  // namespace

void trace_add_16(const float* slab, const TraceEntries& entries, int rows, float* dose) {
  add<16>(slab, entries, rows, dose);
}
void trace_add_32(const float* slab, const TraceEntries& entries, int rows, float* dose) {
  add<32>(slab, entries, rows, dose);
}
void trace_add_64(const float* slab, const TraceEntries& entries, int rows, float* dose) {
  add<64>(slab, entries, rows, dose);
}

}  // namespace vam::light::VAM_SIMD
