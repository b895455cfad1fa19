// SPDX-License-Identifier: GPL-3.0-or-later
// Items by a whole number that each has, as points have edges: a counting sort.
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace vam {

/// The items of each number from 0 on, in the order in which they came.
template <class Item>
class Buckets {
 public:
  /// for_all(put) calls put(number, item) of every item, with a number below `numbers`; it is called twice.
  template <class ForAll>
  Buckets(std::size_t numbers, const ForAll& for_all) : first_(numbers + 1) {
    for_all([&](std::size_t number, const Item&) { ++first_[number + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    items_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for_all([&](std::size_t number, const Item& item) { items_[next[number]++] = item; });
  }
  [[nodiscard]] std::size_t size() const { return first_.size() - 1; }
  [[nodiscard]] std::span<Item> operator[](std::size_t number) {
    return std::span(items_).subspan(first_[number], first_[number + 1] - first_[number]);
  }
  [[nodiscard]] std::span<const Item> operator[](std::size_t number) const {
    return std::span(items_).subspan(first_[number], first_[number + 1] - first_[number]);
  }
  /// Of all numbers.
  [[nodiscard]] const std::vector<Item>& items() const { return items_; }

 private:
  std::vector<std::size_t> first_;
  std::vector<Item> items_;
};

}  // namespace vam
