// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "solid/mesh/private/topology.hpp"
#include "solid/mesh/private/triangle_tree.hpp"

namespace vam::solid {

namespace {

// The triangle across a side.
struct Neighbour {
  int triangle = -1;   // none, or the edge has more than two
  bool agrees = true;  // runs through the edge the other way, as it should
};

// By triangle and side.
std::vector<std::array<Neighbour, 3>> neighbours(const model::TriangleSoup& mesh) {
  std::vector<std::array<Neighbour, 3>> all(mesh.triangles.size());
  for_each_edge(mesh.triangles, mesh.points.size(), [&](int, std::span<const HalfEdge> edge) {
    if (edge.size() != 2) return;
    const bool agrees = edge[0].rising != edge[1].rising;
    for (std::size_t one = 0; one < 2; ++one)
      all[edge[one].triangle][edge[one].side] = {edge[1 - one].triangle, agrees};
  });
  return all;
}

// A set of triangles that hang together.
struct Component {
  std::vector<int> triangles;
  Bounds bounds;
  Measure measure;     // about the middle of the bounds
  bool solid = false;  // nearly closed: has an inside
  bool turn = false;
};

// Components by flood fill; turn[t] = 1 makes triangle t agree with its component's majority.
std::vector<Component> flood(const model::TriangleSoup& mesh, std::vector<char>& turn, long& unorientable) {
  const auto next = neighbours(mesh);
  std::vector<char> seen(mesh.triangles.size(), 0);
  std::vector<Component> components;
  for (std::size_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (seen[seed] != 0) continue;
    Component component;
    component.triangles.push_back(static_cast<int>(seed));
    seen[seed] = 1;
    std::size_t turned = 0;
    for (std::size_t done = 0; done < component.triangles.size(); ++done) {
      const auto t = static_cast<std::size_t>(component.triangles[done]);
      for (const Neighbour& across : next[t]) {
        if (across.triangle < 0) continue;
        const auto other = static_cast<std::size_t>(across.triangle);
        const char wanted = across.agrees ? turn[t] : static_cast<char>(1 - turn[t]);
        if (seen[other] == 0) {
          seen[other] = 1;
          turn[other] = wanted;
          turned += wanted;
          component.triangles.push_back(static_cast<int>(other));
        } else if (turn[other] != wanted && t < other) {
          ++unorientable;
        }
      }
    }
    if (2 * turned > component.triangles.size()) {
      for (const int t : component.triangles) turn[t] ^= 1;
    }
    components.push_back(std::move(component));
  }
  return components;
}

void turn_over(Triangle& triangle) { std::swap(triangle[1], triangle[2]); }

void measure(const model::TriangleSoup& mesh, Component& component) {
  for (const int t : component.triangles)
    for (const int corner : mesh.triangles[t]) component.bounds.add(mesh.points[corner]);
  for (const int t : component.triangles) add(component.measure, mesh, mesh.triangles[t], component.bounds.centre());
  // The vector area of a surface is minus that of its holes; a half sphere has a half of its area, a closed surface 0.
  component.solid =
      length(component.measure.vector_area) < 0.1 * component.measure.area && component.measure.volume != 0;
}

// Is `inner` within `outer`, by the winding number of outer at a few points of inner?
class Nesting {
 public:
  Nesting(const model::TriangleSoup& mesh, const std::vector<Component>& components)
      : mesh_(mesh), components_(components), winding_(components.size()) {}

  bool holds(std::size_t outer, std::size_t inner) {
    if (!components_[outer].bounds.contains(components_[inner].bounds)) return false;
    if (winding_[outer] == nullptr) {
      model::TriangleSoup surface{mesh_.points, {}};
      for (const int t : components_[outer].triangles) surface.triangles.push_back(mesh_.triangles[t]);
      winding_[outer] = std::make_unique<WindingNumber>(surface);
    }
    const std::vector<int>& triangles = components_[inner].triangles;
    constexpr std::size_t samples = 3;
    std::size_t inside = 0;
    for (std::size_t s = 0; s < samples; ++s) {
      const auto t = static_cast<std::size_t>(triangles[s * (triangles.size() - 1) / (samples - 1)]);
      const Point& p = mesh_.points[mesh_.triangles[t][0]];
      if (std::abs((*winding_[outer])(p)) > 0.5) ++inside;
    }
    return inside == samples;
  }

 private:
  const model::TriangleSoup& mesh_;
  const std::vector<Component>& components_;
  std::vector<std::unique_ptr<WindingNumber>> winding_;  // made when first needed
};

// Decides which solid components to turn over. An outermost one must enclose a positive volume; what is inside it
// keeps its sense relative to it.
long turn_outwards(const model::TriangleSoup& mesh, std::vector<Component>& components) {
  std::vector<std::size_t> solids;
  for (std::size_t c = 0; c < components.size(); ++c)
    if (components[c].solid) solids.push_back(c);
  std::sort(solids.begin(), solids.end(), [&](std::size_t a, std::size_t b) {
    const double size_a = components[a].bounds.diagonal();
    const double size_b = components[b].bounds.diagonal();
    return size_a != size_b ? size_a > size_b : a < b;
  });
  Nesting nesting(mesh, components);
  long cavities = 0;
  std::vector<std::size_t> roots;
  for (const std::size_t c : solids) {
    const bool inward = components[c].measure.volume < 0;
    // The outermost container; sought only where the answer matters.
    const auto root = std::find_if(roots.begin(), roots.end(), [&](std::size_t r) {
      const bool matters = inward || components[r].measure.volume < 0;
      return matters && nesting.holds(r, c);
    });
    if (root == roots.end()) {
      roots.push_back(c);
      components[c].turn = inward;
    } else {
      components[c].turn = components[*root].turn;
      if (inward != components[c].turn) ++cavities;
    }
  }
  return cavities;
}

// Pieces that are not closed by themselves (cracks, facets missing all round) may still surround a volume together.
void turn_pieces(const model::TriangleSoup& mesh, std::vector<Component>& components) {
  Bounds bounds;
  for (const Component& piece : components)
    if (!piece.solid) bounds.join(piece.bounds);
  Measure all;
  for (const Component& piece : components) {
    if (piece.solid) continue;
    for (const int t : piece.triangles) add(all, mesh, mesh.triangles[t], bounds.centre());
  }
  if (all.volume >= 0) return;
  for (Component& piece : components) piece.turn = piece.turn || !piece.solid;
}

}  // namespace

Orientation orient(model::TriangleSoup& mesh) {
  Orientation result;
  std::vector<char> turn(mesh.triangles.size(), 0);
  std::vector<Component> components = flood(mesh, turn, result.unorientable);
  for (std::size_t t = 0; t < turn.size(); ++t)
    if (turn[t] != 0) turn_over(mesh.triangles[t]);
  for (Component& component : components) measure(mesh, component);
  result.components = components.size();
  result.cavities = turn_outwards(mesh, components);
  turn_pieces(mesh, components);
  for (const Component& component : components) {
    const bool inward = component.solid && (component.measure.volume < 0) != component.turn;
    if (!inward) result.outward.push_back(component.bounds);
    if (!component.turn) continue;
    for (const int t : component.triangles) {
      turn_over(mesh.triangles[t]);
      turn[t] ^= 1;
    }
  }
  result.flipped = std::count(turn.begin(), turn.end(), 1);
  return result;
}

}  // namespace vam::solid
