// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/private/triangle_tree.hpp"

#include <cmath>
#include <numeric>

#include "base/index.hpp"

namespace vam::solid {

namespace {

constexpr int leaf_size = 4;

/// Nodes of a tree over so many triangles: those of a level have as many each, or one more.
int node_count(int triangles) {
  int count = 0;
  for (int width = 1;; width *= 2) {
    count += width;
    const int each = triangles / width;
    if (each < leaf_size) return count;
    if (each == leaf_size) return count + 2 * (triangles % width);
  }
}

/// Builds the nodes over an order of the triangles. As the median splits, every node's place is known beforehand, and
/// halves are built side by side.
class TreeBuilder {
 public:
  TreeBuilder(const std::vector<TriangleCorners>& soup, std::vector<TriangleNode>& nodes) : soup_(soup), nodes_(nodes) {
    order_.resize(soup.size());
    std::iota(order_.begin(), order_.end(), 0);
    for (const TriangleCorners& t : soup) centroids_.push_back((1.0 / 3.0) * (t[0] + t[1] + t[2]));
    if (soup.empty()) return;
    nodes_.resize(static_cast<std::size_t>(node_count(count_of(soup))));
    build(0, 0, count_of(soup));
  }
  [[nodiscard]] const std::vector<int>& order() const { return order_; }

 private:
  [[nodiscard]] std::size_t at(int position) const { return static_cast<std::size_t>(order_[position]); }

  void build(int root, int begin, int end) {
    constexpr int few = 1000;  // triangles: not worth a thread
    TriangleNode& node = nodes_[root];
    node.begin = begin;
    node.end = end;
    if (end - begin <= leaf_size) {
      for (int i = begin; i < end; ++i)
        for (const Vector3& corner : soup_[at(i)]) node.box.add(corner);
      return;
    }
    const int middle = split(begin, end);
    node.right = root + 1 + node_count(middle - begin);
    const auto half = [&](int i) { i == 0 ? build(root + 1, begin, middle) : build(node.right, middle, end); };
    if (end - begin < few) {
      half(0);
      half(1);
    } else {
      parallel_for(2, half);
    }
    node.box = nodes_[root + 1].box;
    node.box.join(nodes_[node.right].box);
  }

  /// Orders these triangles; returns where the second half begins.
  int split(int begin, int end) {
    Bounds box;
    for (int i = begin; i < end; ++i) box.add(centroids_[at(i)]);
    const Vector3 size = box.size();
    const auto axis = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int a, int b) { return centroids_[a][axis] < centroids_[b][axis]; });
    return middle;
  }

  const std::vector<TriangleCorners>& soup_;
  std::vector<TriangleNode>& nodes_;
  std::vector<Vector3> centroids_;
  std::vector<int> order_;
};

double distance2(const TriangleNode& node, const Vector3& p) {
  double sum = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    const double out = std::max(std::max(node.box.low[d] - p[d], p[d] - node.box.high[d]), 0.0);
    sum += out * out;
  }
  return sum;
}

/// How far along a ray its triangle is; none where it passes by, or is parallel [MT97], as along the faces of solids in
/// a row, where a determinant that is rounded leaves any number.
std::optional<double> distance_to(const TriangleCorners& triangle, const Vector3& from, const Vector3& along) {
  const Vector3 ab = triangle[1] - triangle[0];
  const Vector3 ac = triangle[2] - triangle[0];
  const Vector3 p = cross(along, ac);
  const double determinant = dot(ab, p);
  constexpr double parallel = 1e-9;  // sine
  if (std::abs(determinant) <= parallel * length(ab) * length(ac)) return std::nullopt;
  const Vector3 way = from - triangle[0];
  const double u = dot(way, p) / determinant;
  if (u < 0 || u > 1) return std::nullopt;
  const Vector3 q = cross(way, ab);
  const double v = dot(along, q) / determinant;
  if (v < 0 || u + v > 1) return std::nullopt;
  return dot(ac, q) / determinant;
}

/// Whether a plane across this direction has the cube around the origin on one side and the triangle on the other.
bool is_between(const Vector3& direction, const TriangleCorners& triangle, double half_side) {
  const double reach = half_side * (std::abs(direction[0]) + std::abs(direction[1]) + std::abs(direction[2]));
  const auto [low, high] =
      std::minmax({dot(direction, triangle[0]), dot(direction, triangle[1]), dot(direction, triangle[2])});
  return low > reach || high < -reach;
}

/// The cube around the origin [AM01]: they are apart if a plane across an axis, the triangle's normal, or an axis and
/// an edge is between them.
bool meets(const TriangleCorners& triangle, double half_side) {
  const std::array<Vector3, 3> axes{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  if (is_between(twice_area(triangle), triangle, half_side)) return false;
  for (const Vector3& axis : axes) {
    if (is_between(axis, triangle, half_side)) return false;
    for (std::size_t side = 0; side < 3; ++side) {
      const Vector3 edge = triangle[(side + 1) % 3] - triangle[side];
      if (is_between(cross(axis, edge), triangle, half_side)) return false;
    }
  }
  return true;
}

}  // namespace

TriangleTree::TriangleTree(std::vector<TriangleCorners> soup) {
  const TreeBuilder builder(soup, nodes);
  triangles.reserve(soup.size());
  for (const int i : builder.order()) triangles.push_back(soup[i]);
  order = builder.order();
}

Nearest TriangleTree::nearest(const Vector3& point, int start) const {
  Nearest best;
  const auto look = [&](int triangle) {
    const Vector3 foot = nearest_on(triangles[triangle], point);
    const Vector3 way = point - foot;
    const double d2 = dot(way, way);
    if (d2 < best.distance2) best = {foot, d2, triangle};
  };
  best.distance2 = 1e300;
  look(start);
  struct Waiting {
    int node;
    double distance2;
  };
  std::array<Waiting, 64> stack;  // the median split keeps the depth below 32
  std::size_t waiting = 0;
  stack[waiting++] = {0, 0};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (next.distance2 >= best.distance2) continue;
    const TriangleNode& node = nodes[next.node];
    if (node.right == 0) {
      for (int i = node.begin; i < node.end; ++i) look(i);
      continue;
    }
    Waiting near{next.node + 1, distance2(nodes[next.node + 1], point)};
    Waiting far{node.right, distance2(nodes[node.right], point)};
    if (far.distance2 < near.distance2) std::swap(near, far);
    if (far.distance2 < best.distance2) stack[waiting++] = far;
    if (near.distance2 < best.distance2) stack[waiting++] = near;
  }
  return best;
}

namespace {

/// visit(i) of the triangles in leaves that meet a box, until one returns true, which is returned.
template <class Visit>
bool any_in_box(const TriangleTree& tree, const Bounds& box, const Visit& visit) {
  std::array<int, 64> stack;  // the median split keeps the depth below 32
  std::size_t waiting = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const int index = stack[--waiting];
    const TriangleNode& node = tree.nodes[index];
    if (!node.box.meets(box)) continue;
    if (node.right != 0) {
      stack[waiting++] = node.right;
      stack[waiting++] = index + 1;
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      if (visit(i)) return true;
    }
  }
  return false;
}

}  // namespace

std::optional<Hit> TriangleTree::first_hit(const Vector3& from, const Vector3& along, double least, double most,
                                           const std::function<bool(int triangle)>& counts) const {
  Bounds box;
  box.add(from);
  box.add(from + most * along);
  std::optional<Hit> first;
  any_in_box(*this, box, [&](int i) {
    const auto distance = distance_to(triangles[i], from, along);
    if (distance && *distance >= least && *distance <= most && (!first || *distance < first->distance) &&
        (!counts || counts(i)))
      first = {*distance, i};
    return false;
  });
  return first;
}

bool TriangleTree::meets_cube(const Vector3& centre, double half_side) const {
  const Vector3 half{half_side, half_side, half_side};
  return any_in_box(*this, {centre - half, centre + half}, [&](int i) {
    const auto& [a, b, c] = triangles[i];
    return meets({a - centre, b - centre, c - centre}, half_side);
  });
}

std::vector<TriangleCorners> corners_of(const model::TriangleSoup& mesh, std::vector<int>* places) {
  std::vector<TriangleCorners> triangles;
  triangles.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const TriangleCorners c = corners(mesh, t);
    const Vector3 normal = twice_area(c);
    if (!(dot(normal, normal) > 0)) continue;
    triangles.push_back(c);
    if (places != nullptr) places->push_back(static_cast<int>(t));
  }
  return triangles;
}

Vector3 nearest_on(const TriangleCorners& triangle, const Vector3& p) {
  const auto& [a, b, c] = triangle;
  const Vector3 ab = b - a;
  const Vector3 ac = c - a;
  const Vector3 ap = p - a;
  const double d1 = dot(ab, ap);
  const double d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vector3 bp = p - b;
  const double d3 = dot(ab, bp);
  const double d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  const Vector3 cp = p - c;
  const double d5 = dot(ab, cp);
  const double d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + ((d4 - d3) / (d4 - d3 + d5 - d6)) * (c - b);
  const double share = 1 / (va + vb + vc);
  return a + (vb * share) * ab + (vc * share) * ac;
}

}  // namespace vam::solid
