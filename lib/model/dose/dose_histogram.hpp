// SPDX-License-Identifier: GPL-3.0-or-later
// Counts of dose values with relative resolution 2^-12: a float's leading bits are the bin, so that no range has to be
// known beforehand and counts of several slices simply add up.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>

namespace vam::model {

/// Bins are [v, v (1 + 2^-12)) for v from 2^-24 to 2^40 (any unit), one bin below that range (zero included).
/// Memory: 32 KiB for each factor of two that occurs.
class DoseHistogram {
 public:
  static constexpr int mantissa_bits = 12;
  static constexpr double resolution = 1.0 / (1 << mantissa_bits);

  void add(float dose) { ++bin(key_of(dose)); }
  void merge(const DoseHistogram& other, int times = 1);
  /// Hands over every field: fields(count) for each, to be written or read.
  template <class Fields>
  void exchange(Fields& fields) {
    fields(below_);
    for (auto& page : pages_) {
      int there = page ? 1 : 0;
      fields(there);
      if (there != 0 && !page) page = std::make_unique<CountPage>();
      if (there != 0) fields(*page);
    }
  }

  [[nodiscard]] std::int64_t total() const;
  /// How many values lie in the bin of `dose` or above it.
  [[nodiscard]] std::int64_t count_from(double dose) const;
  /// The middle of the bin that holds the value of rank fraction * (total - 1), 0 <= fraction <= 1; 0 when empty.
  [[nodiscard]] double quantile(double fraction) const;

  /// Visits the bins that are occupied here or in `other` from the highest dose down:
  /// visit(lower edge, upper edge, count here, count there).
  using Visit = std::function<void(double, double, std::int64_t, std::int64_t)>;
  void descend(const DoseHistogram& other, const Visit& visit) const;

 private:
  static constexpr int page_size = 1 << mantissa_bits;
  static constexpr int first_exponent = -24;
  static constexpr int pages = 64;
  using CountPage = std::array<std::int64_t, page_size>;

  static int key_of(float dose);
  static double lower_edge(int key);
  static double upper_edge(int key);
  std::int64_t& bin(int key);
  [[nodiscard]] std::int64_t count(int key) const;

  std::int64_t below_ = 0;  // key -1
  std::array<std::unique_ptr<CountPage>, pages> pages_{};
};

}  // namespace vam::model
