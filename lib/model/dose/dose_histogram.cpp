// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/dose/dose_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vam::model {

namespace {
constexpr int float_mantissa_bits = 23;
constexpr int float_bias = 127;
constexpr int shift = float_mantissa_bits - DoseHistogram::mantissa_bits;
}  // namespace

// Positive IEEE floats are ordered like their bit patterns, so the leading bits are a logarithmic bin number.
int DoseHistogram::key_of(float dose) {
  constexpr int base = (float_bias + first_exponent) << mantissa_bits;
  if (!(dose > 0)) return -1;
  const int key = static_cast<int>(std::bit_cast<std::uint32_t>(dose) >> shift) - base;
  return std::clamp(key, -1, pages * page_size - 1);
}

double DoseHistogram::lower_edge(int key) {
  if (key < 0) return 0.0;
  const double mantissa = 1.0 + static_cast<double>(key % page_size) / page_size;
  return std::ldexp(mantissa, first_exponent + key / page_size);
}

double DoseHistogram::upper_edge(int key) { return lower_edge(key + 1); }

std::int64_t& DoseHistogram::bin(int key) {
  if (key < 0) return below_;
  auto& page = pages_[key / page_size];
  if (!page) page = std::make_unique<CountPage>();
  return (*page)[key % page_size];
}

std::int64_t DoseHistogram::count(int key) const {
  if (key < 0) return below_;
  const auto& page = pages_[key / page_size];
  return page ? (*page)[key % page_size] : 0;
}

void DoseHistogram::merge(const DoseHistogram& other, int times) {
  below_ += times * other.below_;
  for (std::size_t p = 0; p < pages; ++p) {
    if (!other.pages_[p]) continue;
    if (!pages_[p]) pages_[p] = std::make_unique<CountPage>();
    for (std::size_t i = 0; i < page_size; ++i) (*pages_[p])[i] += times * (*other.pages_[p])[i];
  }
}

std::int64_t DoseHistogram::total() const { return count_from(0.0); }

std::int64_t DoseHistogram::count_from(double dose) const {
  std::int64_t sum = 0;
  const int from = key_of(static_cast<float>(dose));
  for (int p = pages - 1; p >= 0 && (p + 1) * page_size > from; --p) {
    if (!pages_[p]) continue;
    for (int key = std::max(from, p * page_size); key < (p + 1) * page_size; ++key) sum += count(key);
  }
  return from < 0 ? sum + below_ : sum;
}

double DoseHistogram::quantile(double fraction) const {
  const std::int64_t all = total();
  if (all == 0) return 0.0;
  const auto rank = static_cast<std::int64_t>(std::floor(fraction * static_cast<double>(all - 1)));
  std::int64_t passed = below_;
  if (rank < passed) return 0.0;
  for (int p = 0; p < pages; ++p) {
    if (!pages_[p]) continue;
    for (int key = p * page_size; key < (p + 1) * page_size; ++key) {
      passed += count(key);
      if (rank < passed) return 0.5 * (lower_edge(key) + upper_edge(key));
    }
  }
  return 0.0;
}

void DoseHistogram::descend(const DoseHistogram& other, const Visit& visit) const {
  for (int p = pages - 1; p >= 0; --p) {
    const auto page = static_cast<std::size_t>(p);
    if (!pages_[page] && !other.pages_[page]) continue;
    for (int key = (p + 1) * page_size - 1; key >= p * page_size; --key) {
      const std::int64_t here = count(key);
      const std::int64_t there = other.count(key);
      if (here + there > 0) visit(lower_edge(key), upper_edge(key), here, there);
    }
  }
  if (below_ + other.below_ > 0) visit(0.0, lower_edge(0), below_, other.below_);
}

}  // namespace vam::model
