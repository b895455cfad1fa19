// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once per instruction set (base/compute/simd.hpp). Both directions work out the same weights from the same
// numbers, so that they are transposes of each other to the rounding of sums.
#include "tomo/private/fourier_kernel.hpp"

#include "base/compute/kernel_vector.hpp"

namespace vam::tomo::VAM_SIMD {

using namespace vam::VAM_SIMD;

namespace {

constexpr int cell = 16;                         // floats of 8 complex values
constexpr int registers = cell / vector_floats;  // that hold them
using Sixteen = float __attribute__((vector_size(64)));
using Four = float __attribute__((vector_size(16)));

/// Where a point's first tap lies, and z of both axes.
struct Place {
  long first;
  float z_x;
  float z_y;
};

inline Place place_of(const GridLine& job, int i, int cell_floats) {
  const double x = job.x + i * job.step_x;
  const double y = job.y + i * job.step_y;
  const int base_x = static_cast<int>(x);  // margins keep both above 0
  const int base_y = static_cast<int>(y);
  return {(base_y - taps_before) * job.row_step + static_cast<long>(base_x - taps_before) * cell_floats,
          static_cast<float>(2 * (x - base_x) - 1), static_cast<float>(2 * (y - base_y) - 1)};
}

/// Taps along x at 0..5, along y at 8..13.
inline void weigh(const TapPolynomials& powers, const Place& place, float (&taps)[16]) {
  for (int e = 0; e < 16; ++e) {
    const float z = e < 8 ? place.z_x : place.z_y;
    float sum = powers.tap[0][e];
#pragma GCC unroll 8
    for (int p = 1; p < tap_powers; ++p) sum = sum * z + powers.tap[p][e];
    taps[e] = sum;
  }
}

/// Taps along x for real and imaginary part, and four zeros.
inline void double_taps(const float (&taps)[16], float (&across)[16]) {
  Sixteen all;
  __builtin_memcpy(&all, taps, sizeof(all));
  all = __builtin_shufflevector(all, all, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7);
  __builtin_memcpy(across, &all, sizeof(all));
}

void interpolate_eight(const GridLine& job) {
  alignas(64) float taps[16];
  for (int i = 0; i < job.count; ++i) {
    const Place place = place_of(job, i, cell);
    weigh(*job.taps, place, taps);
    const float* from = job.grid + place.first;
    Vector sum[registers] = {};
#pragma GCC unroll 6
    for (int r = 0; r < grid_taps; ++r, from += job.row_step) {
      Vector row[registers] = {};
#pragma GCC unroll 6
      for (int c = 0; c < grid_taps; ++c) {
        for (int v = 0; v < registers; ++v) row[v] += taps[c] * load(from + c * cell + v * vector_floats);
      }
      for (int v = 0; v < registers; ++v) sum[v] += taps[8 + r] * row[v];
    }
    for (int v = 0; v < registers; ++v) store(job.line + i * cell + v * vector_floats, sum[v]);
  }
}

void spread_eight(const GridLine& job) {
  alignas(64) float taps[16];
  for (int i = 0; i < job.count; ++i) {
    const Place place = place_of(job, i, cell);
    weigh(*job.taps, place, taps);
    float* to = job.grid + place.first;
    Vector value[registers];
    for (int v = 0; v < registers; ++v) value[v] = load(job.line + i * cell + v * vector_floats);
#pragma GCC unroll 6
    for (int r = 0; r < grid_taps; ++r, to += job.row_step) {
      Vector row[registers];
      for (int v = 0; v < registers; ++v) row[v] = taps[8 + r] * value[v];
#pragma GCC unroll 6
      for (int c = 0; c < grid_taps; ++c) {
        for (int v = 0; v < registers; ++v) {
          float* at = to + c * cell + v * vector_floats;
          store(at, load(at) + taps[c] * row[v]);
        }
      }
    }
  }
}

/// Six cells of one complex value are 12 floats; the weights of the other four are 0.
void interpolate_one(const GridLine& job) {
  alignas(64) float taps[16];
  alignas(64) float across[16];
  for (int i = 0; i < job.count; ++i) {
    const Place place = place_of(job, i, 2);
    weigh(*job.taps, place, taps);
    double_taps(taps, across);
    const float* from = job.grid + place.first;
    Vector even[registers] = {};
    Vector odd[registers] = {};
#pragma GCC unroll 3
    for (int r = 0; r < grid_taps; r += 2, from += 2 * job.row_step) {
      for (int v = 0; v < registers; ++v) {
        even[v] += taps[8 + r] * load(from + v * vector_floats);
        odd[v] += taps[9 + r] * load(from + job.row_step + v * vector_floats);
      }
    }
    Sixteen products;
    for (int v = 0; v < registers; ++v) {
      const Vector product = (even[v] + odd[v]) * load(across + v * vector_floats);
      __builtin_memcpy(reinterpret_cast<char*>(&products) + v * sizeof(product), &product, sizeof(product));
    }
    const Four sum = __builtin_shufflevector(products, products, 0, 1, 2, 3) +
                     __builtin_shufflevector(products, products, 4, 5, 6, 7) +
                     __builtin_shufflevector(products, products, 8, 9, 10, 11);
    job.line[2 * i] = sum[0] + sum[2];
    job.line[2 * i + 1] = job.conjugate ? -(sum[1] + sum[3]) : sum[1] + sum[3];
  }
}

void spread_one(const GridLine& job) {
  alignas(64) float taps[16];
  alignas(64) float across[16];
  for (int i = 0; i < job.count; ++i) {
    const Place place = place_of(job, i, 2);
    weigh(*job.taps, place, taps);
    double_taps(taps, across);
    const float real = job.line[2 * i];
    const float imaginary = job.conjugate ? -job.line[2 * i + 1] : job.line[2 * i + 1];
    for (int e = 0; e < 16; ++e) across[e] *= e % 2 == 0 ? real : imaginary;
    float* to = job.grid + place.first;
#pragma GCC unroll 6
    for (int r = 0; r < grid_taps; ++r, to += job.row_step) {
      for (int v = 0; v < registers; ++v) {
        float* at = to + v * vector_floats;
        store(at, load(at) + taps[8 + r] * load(across + v * vector_floats));
      }
    }
  }
}

using Complex = double __attribute__((may_alias));  // 8 bytes to move

template <int values>
void part(const CellRows& job) {
  const auto* from = reinterpret_cast<const Complex*>(job.cells);
  auto* to = reinterpret_cast<Complex*>(job.rows);
  for (int i = 0; i < job.count; ++i, from += job.cell_step / 2) {
#pragma GCC unroll 8
    for (int p = 0; p < values; ++p) to[p * (job.row_step / 2) + i] = from[p];
  }
}

template <int values>
void join(const CellRows& job) {
  const auto* from = reinterpret_cast<const Complex*>(job.rows);
  auto* to = reinterpret_cast<Complex*>(job.cells);
  for (int i = 0; i < job.count; ++i, to += job.cell_step / 2) {
#pragma GCC unroll 8
    for (int p = 0; p < values; ++p) to[p] = from[p * (job.row_step / 2) + i];
  }
}

void fold(const AliasPair& job) {
  for (int i = 0; i < job.count; ++i) {
    const float* low = job.low + cell * i;
    float* high = job.high + cell * i;
    const float a = job.low_factor[2 * i];
    const float b = job.low_factor[2 * i + 1];
    const float c = job.high_factor[2 * i];
    const float d = job.high_factor[2 * i + 1];
#pragma GCC unroll 8
    for (int p = 0; p < cell; p += 2) {
      const float real = high[p];
      const float imaginary = high[p + 1];
      high[p] = a * low[p] - b * low[p + 1] + c * real - d * imaginary;
      high[p + 1] = a * low[p + 1] + b * low[p] + c * imaginary + d * real;
    }
  }
}

void unfold(const AliasPair& job) {
  for (int i = 0; i < job.count; ++i) {
    float* low = job.low + cell * i;
    float* high = job.high + cell * i;
    const float a = job.low_factor[2 * i];
    const float b = job.low_factor[2 * i + 1];
    const float c = job.high_factor[2 * i];
    const float d = job.high_factor[2 * i + 1];
#pragma GCC unroll 8
    for (int p = 0; p < cell; p += 2) {
      const float real = high[p];
      const float imaginary = high[p + 1];
      low[p] = a * real + b * imaginary;
      low[p + 1] = a * imaginary - b * real;
      high[p] = c * real + d * imaginary;
      high[p + 1] = c * imaginary - d * real;
    }
  }
}

}  // namespace

extern const FourierKernels fourier_kernels = {{interpolate_one, interpolate_eight},
                                               {spread_one, spread_eight},
                                               {part<1>, part<8>},
                                               {join<1>, join<8>},
                                               fold,
                                               unfold};

}  // namespace vam::tomo::VAM_SIMD
