// SPDX-License-Identifier: GPL-3.0-or-later
// Complex transforms along one row, by FFTW in single precision.
#pragma once

#include <complex>
#include <memory>

namespace vam::tomo {

/// A smallest convenient length >= least: 2^n, 3 * 2^n or 5 * 2^n.
[[nodiscard]] int fft_length(int least);

/// In-place transforms of `length` contiguous values on a 64-byte boundary; sums are not scaled. Plans are made by
/// FFTW_ESTIMATE, so that every run does the same arithmetic. One object may serve several threads.
class Fft {
 public:
  explicit Fft(int length);
  ~Fft();
  Fft(const Fft&) = delete;
  Fft& operator=(const Fft&) = delete;
  void forward(std::complex<float>* row) const;
  void backward(std::complex<float>* row) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// In-place transforms of an even number of real values, on a 64-byte boundary and followed by room for two more, to
/// the non-negative half of their spectrum, and back; sums are not scaled.
class RealFft {
 public:
  explicit RealFft(int length);
  ~RealFft();
  RealFft(const RealFft&) = delete;
  RealFft& operator=(const RealFft&) = delete;
  void forward(float* row) const;
  void backward(float* row) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::tomo
