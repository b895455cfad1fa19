// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles that a mesh has more than once.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "solid/mesh/private/topology.hpp"
#include "solid/mesh/private/triangle_tree.hpp"

namespace vam::solid {

namespace {

// A triangle by its sorted corners, whichever way round it runs.
struct TriangleKey {
  Triangle sorted;
  int index;
  bool even;  // an even permutation of the sorted corners
};

// All triangles, those with the same corners next to each other, in the order of the file.
std::vector<TriangleKey> sorted_keys(const model::TriangleSoup& mesh) {
  // Counting sort by the lowest corner, then each short bucket by the others.
  std::vector<std::size_t> first(mesh.points.size() + 1);
  for (const Triangle& t : mesh.triangles) ++first[std::min({t[0], t[1], t[2]}) + 1];
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  std::vector<TriangleKey> keys(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle t = mesh.triangles[i];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    const bool even = t[1] < t[2];
    if (!even) std::swap(t[1], t[2]);
    keys[next[t[0]]++] = {t, static_cast<int>(i), even};
  }
  for (std::size_t low = 0; low + 1 < first.size(); ++low) {
    std::sort(keys.begin() + static_cast<std::ptrdiff_t>(first[low]),
              keys.begin() + static_cast<std::ptrdiff_t>(first[low + 1]),
              [](const TriangleKey& a, const TriangleKey& b) {
                return a.sorted != b.sorted ? a.sorted < b.sorted : a.index < b.index;
              });
  }
  return keys;
}

std::vector<char> marks(const std::vector<std::size_t>& numbers, std::size_t count) {
  std::vector<char> all(count, 0);
  for (const std::size_t number : numbers) all[number] = 1;
  return all;
}

// An edge of triangles that are asked for, and of others. A balance is of those that run up less those that run down.
struct AskedEdge {
  std::vector<std::size_t> patch;  // of those that are asked for
  std::size_t others = 0;
  long balance = 0;  // of the others
  long with = 0;     // of all
};

// Visits the edges of triangles that are asked for, without the others that are dropped.
template <class Visit>
void for_asked_edges(const model::TriangleSoup& mesh, const std::vector<char>& drop, const std::vector<char>& asked,
                     const Visit& visit) {
  std::vector<Triangle> rest;
  std::vector<std::size_t> original;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (drop[t] != 0 && asked[t] == 0) continue;
    rest.push_back(mesh.triangles[t]);
    original.push_back(t);
  }
  EdgeTable(rest, mesh.points.size()).for_each([&](int, std::span<const HalfEdge> edge) {
    AskedEdge found;
    for (const HalfEdge& half : edge) {
      const std::size_t t = original[half.triangle];
      found.with += half.rising ? 1 : -1;
      if (asked[t] != 0) {
        found.patch.push_back(t);
      } else {
        ++found.others;
        found.balance += half.rising ? 1 : -1;
      }
    }
    if (!found.patch.empty()) visit(found);
  });
}

// Which of the triangles left over from copies that cancel are needless: a patch of them is when the other triangles
// meet it and are closed if it is removed, as where two solids touch, or when it is a surface of its own within the
// others, as where one solid fills a cavity of another. A patch that closes a hole stays, and so does a surface of its
// own that is not within others.
class Patches {
 public:
  Patches(const model::TriangleSoup& mesh, const std::vector<char>& drop, const std::vector<std::size_t>& cancelling)
      : mesh_(mesh), patches_(mesh.triangles.size()), keep_(mesh.triangles.size(), 0), met_(mesh.triangles.size(), 0) {
    const std::vector<char> doubtful = marks(cancelling, drop.size());
    for (std::size_t t = 0; t < drop.size(); ++t)
      if (drop[t] == 0 && doubtful[t] == 0) rest_.push_back(mesh.triangles[t]);
    for_asked_edges(mesh, drop, doubtful, [&](const AskedEdge& edge) { join(edge.patch, edge.others); });
  }

  [[nodiscard]] bool needless(std::size_t triangle) {
    const std::size_t root = patches_.of(triangle);
    if (met_[root] == 0) return is_within_others(root);
    return keep_[root] == 0;
  }

 private:
  /// Single triangles of the others may be turned over still, and mislead beside them.
  bool is_mostly_within(std::size_t patch) {
    std::vector<int> points;
    for (std::size_t t = 0; t < patches_.size(); ++t)
      if (patches_.of(t) == patch) points.push_back(mesh_.triangles[t][0]);
    constexpr std::size_t some = 15;
    const std::size_t step = points.size() / some + 1;
    int within = 0;
    int asked = 0;
    for (std::size_t i = 0; i < points.size(); i += step, ++asked)
      within += std::abs((*others_)(mesh_.points[points[i]])) > 0.5 ? 1 : 0;
    return 2 * within > asked;
  }
  bool is_within_others(std::size_t patch) {
    const auto [known, is_new] = within_.try_emplace(patch, false);
    if (is_new) {
      if (!others_) others_.emplace(model::TriangleSoup{mesh_.points, rest_});
      known->second = is_mostly_within(patch);
    }
    return known->second;
  }
  // An edge of the patch with so many other triangles.
  void join(const std::vector<std::size_t>& patch, std::size_t others) {
    std::size_t root = patches_.of(patch.front());
    for (const std::size_t t : patch) {
      const std::size_t other = patches_.of(t);
      if (others > 0 || other == root) continue;
      patches_.join(root, other);
      keep_[root] |= keep_[other];
      met_[root] |= met_[other];
    }
    for (const std::size_t t : patch) {
      if (others > 0) met_[patches_.of(t)] = 1;
      if (others % 2 == 1) keep_[patches_.of(t)] = 1;
    }
  }

  const model::TriangleSoup& mesh_;
  DisjointSets<> patches_;
  std::vector<char> keep_;
  std::vector<char> met_;
  std::vector<Triangle> rest_;           // that do not cancel
  std::optional<WindingNumber> others_;  // of these; made when first needed
  std::map<std::size_t, bool> within_;
};

// Which of further copies that run the same way round must stay: patches without which edges that are balanced would
// not be, as where two overlapping solids end in one face.
class Copies {
 public:
  Copies(const model::TriangleSoup& mesh, const std::vector<char>& drop, const std::vector<std::size_t>& copies)
      : patches_(mesh.triangles.size()), gain_(mesh.triangles.size(), 0) {
    for_asked_edges(mesh, drop, marks(copies, drop.size()),
                    [&](const AskedEdge& edge) { join(edge.patch, edge.balance, edge.with); });
  }

  [[nodiscard]] bool needed(std::size_t triangle) { return gain_[patches_.of(triangle)] > 0; }

 private:
  // An edge of these copies.
  void join(const std::vector<std::size_t>& copies, long balance, long with) {
    if (with != 0) {
      for (const std::size_t t : copies) gain_[patches_.of(t)] -= balance == 0 ? 1 : 0;
      return;
    }
    const std::size_t root = patches_.of(copies.front());
    for (const std::size_t t : copies) {
      const std::size_t other = patches_.of(t);
      if (other == root) continue;
      patches_.join(root, other);
      gain_[root] += gain_[other];
    }
    gain_[root] += balance != 0 ? 1 : 0;
  }

  DisjointSets<> patches_;
  std::vector<long> gain_;  // edges that a patch balances, less those that it unbalances
};

}  // namespace

long drop_duplicates(model::TriangleSoup& mesh) {
  const std::vector<TriangleKey> keys = sorted_keys(mesh);
  std::vector<char> drop(mesh.triangles.size(), 0);
  std::vector<std::size_t> cancelling;  // the first of copies that cancel
  std::vector<std::size_t> copies;      // beyond the first of those that do not
  for (auto group = keys.begin(); group != keys.end();) {
    long balance = 0;
    auto stop = group;
    for (; stop != keys.end() && stop->sorted == group->sorted; ++stop) balance += stop->even ? 1 : -1;
    const auto keep =
        std::find_if(group, stop, [&](const TriangleKey& key) { return balance == 0 || key.even == (balance > 0); });
    for (auto key = group; key != stop; ++key) drop[key->index] = key != keep ? 1 : 0;
    long further = std::abs(balance) - 1;
    for (auto key = keep; further > 0; ++key) {
      if (key == keep || key->even != keep->even) continue;
      copies.push_back(static_cast<std::size_t>(key->index));
      --further;
    }
    if (balance == 0) cancelling.push_back(static_cast<std::size_t>(keep->index));
    group = stop;
  }
  if (!cancelling.empty()) {
    Patches patches(mesh, drop, cancelling);
    for (const std::size_t index : cancelling) drop[index] = patches.needless(index) ? 1 : 0;
  }
  if (!copies.empty()) {
    Copies patches(mesh, drop, copies);
    for (const std::size_t index : copies) drop[index] = patches.needed(index) ? 0 : 1;
  }
  const std::size_t before = mesh.triangles.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < before; ++i) {
    if (drop[i] == 0) mesh.triangles[kept++] = mesh.triangles[i];
  }
  mesh.triangles.resize(kept);
  return static_cast<long>(before - kept);
}

}  // namespace vam::solid
