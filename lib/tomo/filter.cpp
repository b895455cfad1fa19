// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/filter.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "base/text/text.hpp"
#include "tomo/private/fft.hpp"

namespace vam::tomo {

namespace {

using std::numbers::pi;
constexpr double nyquist = 0.5;  // cycles per column

using Row = std::vector<std::complex<float>, CacheAligned<std::complex<float>>>;

/// Kernel of |f| on low <= |f| <= 1/2 at lag n: the band-limited ramp [KS88] less the ramp below `low`,
///   2 int_0^low f cos(2 pi f n) df = low sin(2 pi low n)/(pi n) + (cos(2 pi low n) - 1)/(2 (pi n)^2).
double kernel(int n, double low) {
  if (n == 0) return nyquist * nyquist - low * low;
  const double ramp = n % 2 == 0 ? 0.0 : -1 / (pi * pi * n * n);
  const double phase = 2 * pi * low * n;
  return ramp - (low * std::sin(phase) / (pi * n) + (std::cos(phase) - 1) / (2 * pi * pi * n * n));
}

double window_gain(FilterWindow window, double x) {
  if (window == FilterWindow::gaussian) return std::exp(-x * x);
  if (window == FilterWindow::exponential) return std::exp(-x);
  if (x > 1) return 0;
  switch (window) {
    case FilterWindow::shepp_logan:
      return x == 0 ? 1.0 : std::sin(pi * x / 2) / (pi * x / 2);
    case FilterWindow::cosine:
      return std::cos(pi * x / 2);
    case FilterWindow::hamming:
      return 0.54 + 0.46 * std::cos(pi * x);
    case FilterWindow::hann:
      return 0.5 + 0.5 * std::cos(pi * x);
    default:
      return 1;
  }
}

/// Gains at 0 .. length/2, summed in double: the kernel is even, so its transform is a sum of cosines.
std::vector<double> make_gains(int length, const FilterSpec& spec) {
  const double low = std::min(std::abs(spec.alpha_per_px) / (2 * pi), nyquist);
  const int half = length / 2;
  std::vector<double> lags(static_cast<std::size_t>(half) + 1);
  for (int n = 0; n <= half; ++n) lags[n] = kernel(n, low);
  std::vector<double> cosines(length);
  for (int i = 0; i < length; ++i) cosines[i] = std::cos(2 * pi * i / length);
  std::vector<double> gains(static_cast<std::size_t>(half) + 1);
  parallel_for(half + 1, [&](int m) {
    double sum = lags.front() + (m % 2 == 0 ? 1 : -1) * lags.back();
    for (int n = 1; n < half; ++n) {
      const auto phase = static_cast<std::size_t>(static_cast<long>(m) * n % length);
      sum += 2 * lags[n] * cosines[phase];
    }
    const double x = static_cast<double>(m) / (half * spec.cutoff);
    // Without a floor the small negative gains below alpha stay: they keep the sampled kernel exact.
    const double gain = sum * window_gain(spec.window, x);
    const double kept = spec.floor > 0 ? std::max(gain, spec.floor * nyquist) : gain;
    gains[m] = spec.ceiling < 1 ? std::min(kept, spec.ceiling * nyquist) : kept;
  });
  return gains;
}

}  // namespace

struct Filter::State {
  int columns;
  int length;
  std::vector<double> gains;       // 0 .. length / 2
  std::vector<float> row_factors;  // gain / length at 0 .. length - 1
  Fft fft;

  bool identity = false;

  State(int width, int padded) : columns(width), length(padded), fft(padded) {}
  void filter_row(float* row, Row& work) const;
};

const std::vector<std::string>& window_names() {
  static const std::vector<std::string> names{"none",    "ram-lak", "shepp-logan", "cosine",
                                              "hamming", "hann",    "gaussian",    "exponential"};
  return names;
}

FilterWindow window_from_name(const std::string& name) {
  const auto& names = window_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<FilterWindow>(found - names.begin());
  std::string list;
  for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
  throw Error{Fault::usage, "filter '" + name + "' is unknown; there are " + list};
}

Filter::Filter(int columns, const FilterSpec& spec) {
  if (!(spec.cutoff > 0)) {
    throw Error{Fault::usage,
                "filter cutoff " + format_number(spec.cutoff) + " must be above 0 (a fraction of Nyquist)"};
  }
  if (!(spec.floor >= 0 && spec.floor <= 1)) {
    throw Error{Fault::usage,
                "filter floor " + format_number(spec.floor) + " must lie in 0..1 (of the gain at Nyquist)"};
  }
  if (!(spec.ceiling >= spec.floor && spec.ceiling > 0)) {
    throw Error{Fault::usage, "filter ceiling " + format_number(spec.ceiling) + " must not be below its floor " +
                                  format_number(spec.floor)};
  }
  const int length = fft_length(std::max(2 * columns, 4));
  state_ = std::make_unique<State>(columns, length);
  const auto half = static_cast<std::size_t>(length) / 2;
  state_->identity = spec.window == FilterWindow::none;
  state_->gains = state_->identity ? std::vector<double>(half + 1, 1.0) : make_gains(length, spec);
  for (int m = 0; m < length; ++m) {
    const auto folded = static_cast<std::size_t>(std::min(m, length - m));
    state_->row_factors.push_back(static_cast<float>(state_->gains[folded] / length));
  }
}

Filter::~Filter() = default;
Filter::Filter(Filter&&) noexcept = default;
Filter& Filter::operator=(Filter&&) noexcept = default;

const std::vector<double>& Filter::gains() const { return state_->gains; }

/// Two lanes make one complex signal: the gain is real and even, so real and imaginary parts do not mix.
void Filter::State::filter_row(float* row, Row& work) const {
  for (int lane = 0; lane < lanes; lane += 2) {
    const float* from = row + lane;
    for (int c = 0; c < columns; ++c, from += lanes) work[c] = {from[0], from[1]};
    std::fill(work.begin() + columns, work.end(), std::complex<float>{});
    fft.forward(work.data());
    for (std::size_t m = 0; m < work.size(); ++m) work[m] *= row_factors[m];
    fft.backward(work.data());
    float* to = row + lane;
    for (int c = 0; c < columns; ++c, to += lanes) {
      to[0] = work[c].real();
      to[1] = work[c].imag();
    }
  }
}

void Filter::apply(Slab& sinogram) const {
  if (sinogram.width != state_->columns) {
    throw Error{Fault::bug, "filter for " + std::to_string(state_->columns) + " columns got a sinogram of " +
                                std::to_string(sinogram.width)};
  }
  if (state_->identity) return;
  constexpr int rows_an_item = 8;
  const int items = (sinogram.height + rows_an_item - 1) / rows_an_item;
  parallel_for(items, [&](int item) {
    Row work(state_->length);
    const int last = std::min((item + 1) * rows_an_item, sinogram.height);
    for (int a = item * rows_an_item; a < last; ++a) state_->filter_row(sinogram.at(0, a), work);
  });
}

}  // namespace vam::tomo
