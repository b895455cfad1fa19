// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the image are transformed into rows of the grid, then the grid's columns in place: rows of zeros are neither
// transformed nor kept.
#include "tomo/private/fourier_grid.hpp"

#include <algorithm>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "tomo/private/gridding.hpp"

namespace vam::tomo {

namespace {

constexpr int spare_cells = 4;  // after a row: where it has 6 taps of one value the kernel touches 8 cells

std::complex<float>* row_of(float* rows, int pitch, int row) {
  return reinterpret_cast<std::complex<float>*>(rows) + static_cast<std::ptrdiff_t>(row) * pitch;
}

/// work(first pixel, first grid point, count) for the pixels from the centre on and for those before it.
template <class Work>
void for_stretches(int pixels, int centre, int points, const Work& work) {
  work(centre, 0, pixels - centre);
  work(0, points - centre, centre);
}

void scale(float* row, const float* weights, float weight, int count, int parts) {
  for (int i = 0; i < count; ++i) {
    for (int part = 0; part < parts; ++part) row[static_cast<std::ptrdiff_t>(i) * parts + part] *= weights[i] * weight;
  }
}

void add(const float* from, std::ptrdiff_t count, float* to) {
  for (std::ptrdiff_t i = 0; i < count; ++i) to[i] += from[i];
}

}  // namespace

FourierGrid::FourierGrid(const FourierPlan& plan, const FourierKernels& kernels)
    : plan_(plan),
      kernels_(kernels),
      values_(plan.real ? 1 : lanes / 2),
      cell_(std::ptrdiff_t{2} * values_),
      row_step_((plan.kept_x() + 2 * grid_margin + spare_cells) * cell_),
      fft_x_(plan.grid_x),
      real_fft_x_(plan.grid_x),
      fft_y_(plan.grid_y),
      grid_((plan.grid_y + 2 * grid_margin) * row_step_ + lanes) {
  for (int y = 0; y < plan.tiles_y; ++y) {
    for (int x = 0; x < plan.tiles_x; ++x) colours_.at(y % 2 * 2 + x % 2).push_back(y * plan.tiles_x + x);
  }
}

/// Values of a row of pixels, in the order of the transform, zeros between: 8 rows of complex ones, or one of real
/// ones.
void FourierGrid::load(const Slab& image, int y, float* rows, int pitch) const {
  std::fill_n(rows, cell_ * pitch, 0.0F);
  for_stretches(plan_.width, plan_.centre_x, plan_.grid_x, [&](int pixel, int point, int count) {
    const float* from = image.at(pixel, y);
    if (plan_.real) {
      for (int i = 0; i < count; ++i) rows[point + i] = from[static_cast<std::ptrdiff_t>(i) * lanes];
      scale(rows + point, &plan_.weight_x[pixel], plan_.weight_y[y], count, 1);
      return;
    }
    kernels_.part[1]({const_cast<float*>(from), lanes, rows + 2L * point, 2L * pitch, count});
    for (int v = 0; v < values_; ++v)
      scale(rows + 2L * (static_cast<std::ptrdiff_t>(v) * pitch + point), &plan_.weight_x[pixel], plan_.weight_y[y],
            count, 2);
  });
}

void FourierGrid::store(Slab& image, int y, float* rows, int pitch) const {
  for_stretches(plan_.width, plan_.centre_x, plan_.grid_x, [&](int pixel, int point, int count) {
    float* to = image.at(pixel, y);
    if (plan_.real) {
      scale(rows + point, &plan_.weight_x[pixel], plan_.weight_y[y], count, 1);
      for (int i = 0; i < count; ++i, to += lanes) {
        std::fill_n(to, lanes, 0.0F);
        *to = rows[point + i];
      }
      return;
    }
    for (int v = 0; v < values_; ++v)
      scale(rows + 2L * (static_cast<std::ptrdiff_t>(v) * pitch + point), &plan_.weight_x[pixel], plan_.weight_y[y],
            count, 2);
    kernels_.join[1]({to, lanes, rows + 2L * point, 2L * pitch, count});
  });
}

void FourierGrid::transform_rows(float* rows, int pitch, bool forward) const {
  if (plan_.real) return forward ? real_fft_x_.forward(rows) : real_fft_x_.backward(rows);
  for (int v = 0; v < values_; ++v) {
    auto* row = row_of(rows, pitch, v);
    forward ? fft_x_.forward(row) : fft_x_.backward(row);
  }
}

int FourierGrid::row_of_pixels(int y) const {
  return grid_margin + (y < plan_.centre_y ? y - plan_.centre_y + plan_.grid_y : y - plan_.centre_y);
}

void FourierGrid::transform(const Slab& image) {
  const int pitch = pitch_of(plan_.grid_x);
  parallel_for(plan_.height, [&](int y) {
    float* rows = scratch(0, product(cell_, pitch + 8));
    load(image, y, rows, pitch);
    transform_rows(rows, pitch, true);
    kernels_.join[kernel()]({at(grid_margin, row_of_pixels(y)), cell_, rows, 2L * pitch, plan_.kept_x()});
  });
  columns(true);
  fill_margins();
}

void FourierGrid::transform_back(Slab& image) {
  fold_margins();
  columns(false);
  const int pitch = pitch_of(plan_.grid_x);
  parallel_for(plan_.height, [&](int y) {
    float* rows = scratch(0, product(cell_, pitch + 8));
    kernels_.part[kernel()]({at(grid_margin, row_of_pixels(y)), cell_, rows, 2L * pitch, plan_.kept_x()});
    transform_rows(rows, pitch, false);
    store(image, y, rows, pitch);
  });
}

void FourierGrid::columns(bool forward) {
  const int a_line = lanes / 2 / values_;  // cells of a cache line are worked on together
  parallel_for((plan_.kept_x() + a_line - 1) / a_line, [&](int item) {
    const int end = std::min((item + 1) * a_line, plan_.kept_x());
    for (int x = item * a_line; x < end; ++x) column(x, forward);
  });
}

void FourierGrid::column(int x, bool forward) {
  const int pitch = pitch_of(plan_.grid_y);
  float* rows = scratch(0, product(cell_, pitch));
  const auto job = [&](int point, int count) {
    return CellRows{at(grid_margin + x, grid_margin + point), row_step_, rows + 2L * point, 2L * pitch, count};
  };
  const auto image_rows = [&](const auto& copy) {
    for_stretches(plan_.height, plan_.centre_y, plan_.grid_y,
                  [&](int, int point, int count) { copy(job(point, count)); });
  };
  if (forward) {
    std::fill_n(rows, cell_ * pitch, 0.0F);
    image_rows(kernels_.part[kernel()]);
    for (int v = 0; v < values_; ++v) fft_y_.forward(row_of(rows, pitch, v));
    kernels_.join[kernel()](job(0, plan_.grid_y));
  } else {
    kernels_.part[kernel()](job(0, plan_.grid_y));
    for (int v = 0; v < values_; ++v) fft_y_.backward(row_of(rows, pitch, v));
    image_rows(kernels_.join[kernel()]);
  }
}

/// work(row, cell in the margin, its row, the cell that it repeats, whether as the conjugate).
template <class Work>
void FourierGrid::for_margin_columns(const Work& work) const {
  parallel_for(plan_.grid_y, [&](int y) {
    const int opposite = y == 0 ? 0 : plan_.grid_y - y;
    for (int m = 1; m <= grid_margin; ++m) {
      const int last = plan_.kept_x() - 1;
      if (plan_.real) {
        work(-m, y, m, opposite, true);
        work(last + m, y, last - m, opposite, true);
      } else {
        work(-m, y, last + 1 - m, y, false);
        work(last + m, y, m - 1, y, false);
      }
    }
  });
}

/// work(row in the margin, the row that it repeats).
template <class Work>
void FourierGrid::for_margin_rows(const Work& work) const {
  for (int y = 0; y < grid_margin; ++y) {
    work(y, plan_.grid_y + y);
    work(grid_margin + plan_.grid_y + y, grid_margin + y);
  }
}

void FourierGrid::fill_margins() {
  for_margin_columns([&](int x, int y, int from_x, int from_y, bool conjugate) {
    float* to = at(grid_margin + x, grid_margin + y);
    std::copy_n(at(grid_margin + from_x, grid_margin + from_y), cell_, to);
    if (conjugate) to[1] = -to[1];
  });
  for_margin_rows([&](int y, int from) { std::copy_n(at(0, from), row_step_, at(0, y)); });
}

/// The transpose. Of a single slice the half of the grid that is not kept lights as the one that is, so that only what
/// is in both, its edges, counts once more.
void FourierGrid::fold_margins() {
  for_margin_rows([&](int y, int to) { add(at(0, y), row_step_, at(0, to)); });
  for_margin_columns([&](int x, int y, int to_x, int to_y, bool conjugate) {
    float* from = at(grid_margin + x, grid_margin + y);
    if (conjugate) from[1] = -from[1];
    add(from, cell_, at(grid_margin + to_x, grid_margin + to_y));
  });
  if (!plan_.real) return;
  for (int y = 0; y < plan_.grid_y; ++y) {
    for (const int x : {0, plan_.kept_x() - 1}) {
      float* edge = at(grid_margin + x, grid_margin + y);
      add(edge, cell_, edge);
    }
  }
}

GridLine FourierGrid::line_of(const LineRun& run, float* lines) {
  const double step_x = run.sign * plan_.step_x(run.angle);
  const double step_y = run.sign * plan_.step_y(run.angle);
  const std::size_t first = product(run.angle, plan_.points()) + run.first - plan_.first_j();
  return {&tap_polynomials(),
          grid_.data(),
          row_step_,
          run.first * step_x + run.shift_x + grid_margin,
          run.first * step_y + run.shift_y + grid_margin,
          step_x,
          step_y,
          run.count,
          run.sign < 0,
          lines + first * cell_};
}

void FourierGrid::interpolate(float* lines) {
  parallel_for(count_of(plan_.tiles), [&](int tile) {
    for (const LineRun& run : plan_.tiles[tile]) kernels_.interpolate[kernel()](line_of(run, lines));
  });
}

void FourierGrid::spread(float* lines) {
  parallel_for(plan_.grid_y + 2 * grid_margin, [&](int y) { std::fill_n(at(0, y), row_step_, 0.0F); });
  for (const std::vector<int>& tiles : colours_) {
    parallel_for(count_of(tiles), [&](int i) {
      for (const LineRun& run : plan_.tiles[tiles[i]]) kernels_.spread[kernel()](line_of(run, lines));
    });
  }
}

}  // namespace vam::tomo
