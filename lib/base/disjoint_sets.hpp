// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of numbers that are joined step by step.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace vam {

/// The numbers from 0 on, each of one set. A set is named by one of its numbers.
template <class Index = std::size_t>
class DisjointSets {
 public:
  /// So many sets of one number.
  explicit DisjointSets(std::size_t numbers) : parent_(numbers) { std::iota(parent_.begin(), parent_.end(), Index{0}); }
  /// The name of the set; shortens the ways that it follows.
  [[nodiscard]] Index of(Index number) {
    while (parent_[number] != number) number = parent_[number] = parent_[parent_[number]];
    return number;
  }
  /// The set named `other` becomes a part of the one named `set`, whose name it takes.
  void join(Index set, Index other) { parent_[other] = set; }
  [[nodiscard]] std::size_t size() const { return parent_.size(); }

 private:
  std::vector<Index> parent_;
};

}  // namespace vam
