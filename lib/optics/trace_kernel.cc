#include "optics/trace_kernel.hpp"

namespace vam::optics::VAM_SIMD {

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
inline void add(const float* slab, const TraceEntries& entries, int rows, float* __restrict dose) {
  float sum[lanes];
  for (int s = 0; s < lanes; ++s) sum[s] = dose[s];
  for (int i = 0; i < rows; ++i) {
    const float* at = slab + static_cast<long>(entries.cell[i]) * lanes;
    const float left = entries.left[i];
    const float right = entries.right[i];
    for (int s = 0; s < lanes; ++s) sum[s] += left * at[s] + right * at[lanes + s];
  }
  for (int s = 0; s < lanes; ++s) dose[s] = sum[s];
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

}  // namespace vam::optics::VAM_SIMD
