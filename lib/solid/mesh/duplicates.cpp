// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles that a mesh has more than once.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <vector>

#include "base/buckets.hpp"
#include "base/disjoint_sets.hpp"
#include "base/index.hpp"
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
Buckets<TriangleKey> sorted_keys(const model::TriangleSoup& mesh) {
  Buckets<TriangleKey> by_lowest(mesh.points.size(), [&](const auto& put) {
    for (int i = 0; i < count_of(mesh.triangles); ++i) {
      Triangle t = mesh.triangles[i];
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      const bool even = t[1] < t[2];
      if (!even) std::swap(t[1], t[2]);
      put(t[0], TriangleKey{t, i, even});
    }
  });
  for (std::size_t low = 0; low < by_lowest.size(); ++low) {
    std::sort(by_lowest[low].begin(), by_lowest[low].end(), [](const TriangleKey& a, const TriangleKey& b) {
      return a.sorted != b.sorted ? a.sorted < b.sorted : a.index < b.index;
    });
  }
  return by_lowest;
}

/// Triangles that are there several times, of which either one stays or as many as run one way more than the other:
/// none of those that cancel. A patch of them hangs together by edges that no others have. All edges that it has with
/// others vote, by what closes them: one, to close a hole; more, where two overlapping solids end in one face; none,
/// where two solids touch. A surface of its own stays once unless it cancels within others, as where one solid fills a
/// cavity of another.
class Patches {
 public:
  /// times: how often each triangle stays but for that; copied: those for which that is asked.
  Patches(const model::TriangleSoup& mesh, const std::vector<int>& times, const std::vector<char>& copied)
      : mesh_(mesh), times_(times), copied_(copied), patches_(times.size()), votes_(times.size()), met_(times.size()) {
    std::vector<Triangle> there;
    for (std::size_t t = 0; t < times.size(); ++t) {
      if (times[t] == 0 && copied[t] == 0) continue;
      there.push_back(mesh.triangles[t]);
      places_.push_back(t);
      if (copied[t] == 0) rest_.push_back(mesh.triangles[t]);
    }
    for_each_edge(there, mesh.points.size(), [&](int, std::span<const HalfEdge> edge) { vote(edge); });
  }

  [[nodiscard]] bool stays_once(std::size_t triangle) {
    const std::size_t root = patches_.of(triangle);
    return votes_[root] >= 0 && (times_[triangle] > 0 || met_[root] != 0 || !is_within_others(root));
  }

 private:
  void vote(std::span<const HalfEdge> edge) {
    std::vector<std::size_t> asked;
    std::size_t others = 0;
    long balance = 0;  // of the others: those that run up less those that run down
    long with_one = 0;
    long with_all = 0;
    for (const HalfEdge& half : edge) {
      const std::size_t t = places_[half.triangle];
      const int way = half.rising ? 1 : -1;
      if (copied_[t] == 0) {
        ++others;
        balance += way;
      } else {
        asked.push_back(t);
        with_one += way;
        with_all += way * times_[t];
      }
    }
    for (const std::size_t t : asked) {
      const std::size_t root = patches_.of(t);
      if (others == 0) {
        join(patches_.of(asked.front()), root);
        continue;
      }
      met_[root] = 1;
      // Which way round one of those that cancel runs means nothing.
      if (times_[t] == 0) votes_[root] += others % 2 == 1 ? 1 : -1;
      if (times_[t] > 0) votes_[root] += (balance + with_one == 0 ? 1 : 0) - (balance + with_all == 0 ? 1 : 0);
    }
  }
  void join(std::size_t root, std::size_t other) {
    if (root == other) return;
    patches_.join(root, other);
    votes_[root] += votes_[other];
    met_[root] |= met_[other];
  }
  bool is_within_others(std::size_t patch) {
    const auto [known, is_new] = within_.try_emplace(patch, false);
    if (is_new) {
      if (!others_) others_.emplace(model::TriangleSoup{mesh_.points, rest_});
      known->second = is_mostly_within(patch);
    }
    return known->second;
  }
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

  const model::TriangleSoup& mesh_;
  const std::vector<int>& times_;
  const std::vector<char>& copied_;
  DisjointSets<> patches_;
  std::vector<long> votes_;  // for one
  std::vector<char> met_;    // has an edge with others
  std::vector<std::size_t> places_;
  std::vector<Triangle> rest_;           // of which there are no copies
  std::optional<WindingNumber> others_;  // of these; made when first needed
  std::map<std::size_t, bool> within_;
};

}  // namespace

long drop_duplicates(model::TriangleSoup& mesh) {
  const Buckets<TriangleKey> by_lowest = sorted_keys(mesh);
  const std::vector<TriangleKey>& keys = by_lowest.items();
  std::vector<int> times(mesh.triangles.size(), 0);
  std::vector<char> copied(mesh.triangles.size(), 0);
  for (auto group = keys.begin(); group != keys.end();) {
    int balance = 0;
    auto stop = group;
    for (; stop != keys.end() && stop->sorted == group->sorted; ++stop) balance += stop->even ? 1 : -1;
    const auto keep =
        std::find_if(group, stop, [&](const TriangleKey& key) { return balance == 0 || key.even == (balance > 0); });
    times[keep->index] = std::abs(balance);
    copied[keep->index] = std::abs(balance) != 1 ? 1 : 0;
    group = stop;
  }
  std::optional<Patches> patches;
  if (std::find(copied.begin(), copied.end(), 1) != copied.end()) patches.emplace(mesh, times, copied);
  std::vector<Triangle> kept;
  kept.reserve(times.size());
  for (std::size_t t = 0; t < times.size(); ++t) {
    const int count = copied[t] != 0 && patches->stays_once(t) ? 1 : times[t];
    kept.insert(kept.end(), count, mesh.triangles[t]);
  }
  mesh.triangles.swap(kept);
  return static_cast<long>(kept.size()) - count_of(mesh.triangles);
}

}  // namespace vam::solid
