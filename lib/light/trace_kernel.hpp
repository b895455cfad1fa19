// The inner loops of trace.cpp, once per instruction set.
#pragma once

namespace vam::light {

inline constexpr int trace_rows = 64;  // stage angles a pass

/// Where a voxel takes its light from, for up to trace_rows stage angles: cell = row * columns + column.
struct TraceEntries {
  int cell[trace_rows];
  float left[trace_rows];   // weight of the cell
  float right[trace_rows];  // weight of the next column
};

/// Four series of the table around the voxel (two radii x two directions) and the weights of the second of each pair.
struct TraceSource {
  const float* x_p[4];
  const float* strength[4];
  float radius_part;
  float direction_part;
};

/// From millimetres to padded columns: column = scale * x_p + origin, held within [0, last].
struct TraceColumns {
  float scale;
  float origin;
  float last;
  int stride;  // columns of a row, padding included
};

#define VAM_TRACE_KERNELS                                                                       \
  void trace_entries(const TraceSource& source, const TraceColumns& columns, int row, int rows, \
                     TraceEntries& entries);                                                    \
  void trace_add_16(const float* slab, const TraceEntries& entries, int rows, float* dose);     \
  void trace_add_32(const float* slab, const TraceEntries& entries, int rows, float* dose);     \
  void trace_add_64(const float* slab, const TraceEntries& entries, int rows, float* dose);

namespace baseline {
VAM_TRACE_KERNELS
}
namespace avx2 {
VAM_TRACE_KERNELS
}
namespace avx512 {
VAM_TRACE_KERNELS
}
#undef VAM_TRACE_KERNELS

}  // namespace vam::light
