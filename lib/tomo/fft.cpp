// SPDX-License-Identifier: GPL-3.0-or-later
#include "tomo/private/fft.hpp"

#include <fftw3.h>

#include <mutex>

#include "base/compute/aligned_memory.hpp"
#include "base/compute/slab.hpp"
#include "base/error.hpp"

namespace vam::tomo {

namespace {

std::mutex& planner() {  // FFTW's planner is not thread-safe, its transforms are
  static std::mutex mutex;
  return mutex;
}

constexpr std::size_t enough = std::size_t{3} << 20;  // for a plan: FFTW ends the process where memory is refused

fftwf_complex* raw(std::complex<float>* row) { return reinterpret_cast<fftwf_complex*>(row); }

}  // namespace

struct Fft::State {
  fftwf_plan forward = nullptr;
  fftwf_plan backward = nullptr;
};

int fft_length(int least) {
  int best = 1;
  while (best < least) best *= 2;
  for (const int odd : {3, 5}) {
    int length = odd;
    while (length < least) length *= 2;
    if (length < best) best = length;
  }
  return best;
}

Fft::Fft(int length) : state_(std::make_unique<State>()) {
  std::vector<std::complex<float>, CacheAligned<std::complex<float>>> example(length);
  const std::lock_guard<std::mutex> lock(planner());
  free_aligned(allocate_aligned(enough), enough);
  state_->forward = fftwf_plan_dft_1d(length, raw(example.data()), raw(example.data()), FFTW_FORWARD, FFTW_ESTIMATE);
  state_->backward = fftwf_plan_dft_1d(length, raw(example.data()), raw(example.data()), FFTW_BACKWARD, FFTW_ESTIMATE);
  if (state_->forward == nullptr || state_->backward == nullptr) throw Error{Fault::bug, "FFTW made no plan"};
}

Fft::~Fft() {
  const std::lock_guard<std::mutex> lock(planner());
  fftwf_destroy_plan(state_->forward);
  fftwf_destroy_plan(state_->backward);
}

struct RealFft::State {
  fftwf_plan forward = nullptr;
  fftwf_plan backward = nullptr;
};

RealFft::RealFft(int length) : state_(std::make_unique<State>()) {
  std::vector<float, CacheAligned<float>> row(static_cast<std::size_t>(length) + 2);
  auto* const spectrum = reinterpret_cast<fftwf_complex*>(row.data());
  const std::lock_guard<std::mutex> lock(planner());
  free_aligned(allocate_aligned(enough), enough);
  state_->forward = fftwf_plan_dft_r2c_1d(length, row.data(), spectrum, FFTW_ESTIMATE);
  state_->backward = fftwf_plan_dft_c2r_1d(length, spectrum, row.data(), FFTW_ESTIMATE);
  if (state_->forward == nullptr || state_->backward == nullptr) throw Error{Fault::bug, "FFTW made no plan"};
}

RealFft::~RealFft() {
  const std::lock_guard<std::mutex> lock(planner());
  fftwf_destroy_plan(state_->forward);
  fftwf_destroy_plan(state_->backward);
}

void RealFft::forward(float* row) const {
  fftwf_execute_dft_r2c(state_->forward, row, reinterpret_cast<fftwf_complex*>(row));
}

void RealFft::backward(float* row) const {
  fftwf_execute_dft_c2r(state_->backward, reinterpret_cast<fftwf_complex*>(row), row);
}

void Fft::forward(std::complex<float>* row) const { fftwf_execute_dft(state_->forward, raw(row), raw(row)); }
void Fft::backward(std::complex<float>* row) const { fftwf_execute_dft(state_->backward, raw(row), raw(row)); }

}  // namespace vam::tomo
