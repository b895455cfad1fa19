// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/render.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/index.hpp"
#include "plot/canvas.hpp"

namespace vam::plot {

namespace {

constexpr int supersample = 2;
constexpr double ambient = 0.35;  // of the light, from everywhere

Vector3 unit(const Vector3& v) {
  const double size = length(v);
  return size > 0 ? (1 / size) * v : Vector3{0, 0, 1};
}

/// The directions to the right, up and towards the eye.
struct View {
  explicit View(Eye eye) {
    const double a = eye.azimuth_deg * std::numbers::pi / 180;
    const double e = eye.elevation_deg * std::numbers::pi / 180;
    right = {std::cos(a), std::sin(a), 0};
    towards = {std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e)};
    up = cross(towards, right);
    light = unit(towards - 0.5 * right + 0.6 * up);
  }
  Vector3 right{}, up{}, towards{}, light{};
};

struct Corner {
  double x = 0;
  double y = 0;
  double near = 0;
};

/// What is nearest at a pixel.
struct Seen {
  double near = -std::numeric_limits<double>::infinity();
  int body = -1;  // none
  int triangle = 0;
  Vector3 weight{};  // of its corners
};

/// The nearest triangles so far.
class Screen {
 public:
  explicit Screen(int size) : size_(size), seen_(product(size, size)) {}

  void draw(const std::array<Corner, 3>& t, int body, int triangle) {
    const double area = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y);
    if (area == 0) return;
    const auto [left, right] = inside(t[0].x, t[1].x, t[2].x);
    const auto [top, bottom] = inside(t[0].y, t[1].y, t[2].y);
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const double px = x + 0.5;
        const double py = y + 0.5;
        const double a = ((t[1].x - px) * (t[2].y - py) - (t[2].x - px) * (t[1].y - py)) / area;
        const double b = ((t[2].x - px) * (t[0].y - py) - (t[0].x - px) * (t[2].y - py)) / area;
        if (a < 0 || b < 0 || a + b > 1) continue;
        const Vector3 weight{a, b, 1 - a - b};
        const double near = weight[0] * t[0].near + weight[1] * t[1].near + weight[2] * t[2].near;
        Seen& seen = seen_[product(y, size_) + static_cast<std::size_t>(x)];
        if (near > seen.near) seen = {near, body, triangle, weight};
      }
    }
  }

  [[nodiscard]] const std::vector<Seen>& seen() const { return seen_; }

 private:
  /// The first and the last pixel whose centres are between these.
  [[nodiscard]] std::pair<int, int> inside(double a, double b, double c) const {
    const auto [low, high] = std::minmax({a, b, c});
    return {static_cast<int>(std::max(std::ceil(low - 0.5), 0.0)),
            static_cast<int>(std::min(std::floor(high - 0.5), size_ - 1.0))};
  }

  int size_;
  std::vector<Seen> seen_;
};

/// Means of supersample x supersample pixels.
RgbImage reduced(const RgbImage& image) {
  RgbImage out(image.width / supersample, image.height / supersample);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        int sum = 0;
        for (int n = 0; n < supersample * supersample; ++n)
          sum += image(supersample * x + n % supersample, supersample * y + n / supersample)[c];
        out(x, y)[c] = static_cast<std::uint8_t>(sum / (supersample * supersample));
      }
    }
  }
  return out;
}

Vector3 normal_of(const Body& body, const std::array<int, 3>& triangle) {
  const auto& points = body.mesh.points;
  return cross(points[triangle[1]] - points[triangle[0]], points[triangle[2]] - points[triangle[0]]);
}

/// Normals at corners: means of the triangles around a point, by their area, as far as no sharp edge parts them.
class Smoothed {
 public:
  explicit Smoothed(const Body& body) : begin_(body.mesh.points.size() + 1) {
    for (const auto& triangle : body.mesh.triangles) {
      normals_.push_back(normal_of(body, triangle));
      units_.push_back(unit(normals_.back()));
      for (const int corner : triangle) ++begin_[corner + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    around_.resize(begin_.back());
    std::vector<std::size_t> next = begin_;
    for (std::size_t t = 0; t < normals_.size(); ++t) {
      for (const int corner : body.mesh.triangles[t]) around_[next[corner]++] = t;
    }
  }
  [[nodiscard]] Vector3 at(std::size_t triangle, int point) const {
    constexpr double sharp = 0.8;  // the cosine of some 35 degrees
    Vector3 sum{};
    for (std::size_t n = begin_[point]; n < begin_[point + 1]; ++n) {
      if (dot(units_[around_[n]], units_[triangle]) > sharp) sum = sum + normals_[around_[n]];
    }
    return unit(sum);
  }

 private:
  std::vector<Vector3> normals_;     // as long as the area
  std::vector<Vector3> units_;       // of length 1
  std::vector<std::size_t> begin_;   // of each point, in around_
  std::vector<std::size_t> around_;  // triangles
};

/// The colours of a triangle's corners in the light.
std::array<Vector3, 3> lit_corners(const Body& body, const Smoothed& normals, int triangle, const View& view) {
  std::array<Vector3, 3> colours;
  for (std::size_t n = 0; n < 3; ++n) {
    const int at = body.mesh.triangles[triangle][n];
    const double shade = ambient + (1 - ambient) * std::abs(dot(normals.at(triangle, at), view.light));
    const Rgb own = body.colours.empty() ? paint::light_grey : body.colours[at];
    colours[n] = shade * Vector3{double(own[0]), double(own[1]), double(own[2])};
  }
  return colours;
}

/// Only what is seen is lit: most triangles of a volume's surface are behind others, or smaller than a pixel.
RgbImage lit(const std::vector<Seen>& pixels, const std::vector<const Body*>& bodies, const View& view, int size) {
  std::vector<Smoothed> normals;
  for (const Body* body : bodies) normals.emplace_back(*body);
  RgbImage image(size, size, paint::white);
  std::array<Vector3, 3> colours{};
  Seen last;  // whose colours these are: neighbours are often of one triangle
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Seen& seen = pixels[i];
    if (seen.body < 0) continue;
    if (seen.body != last.body || seen.triangle != last.triangle)
      colours = lit_corners(*bodies[seen.body], normals[seen.body], seen.triangle, view);
    last = seen;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value =
          seen.weight[0] * colours[0][c] + seen.weight[1] * colours[1][c] + seen.weight[2] * colours[2][c];
      image.values[i][c] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    }
  }
  return image;
}

}  // namespace

double side_mm(const std::vector<const Body*>& bodies, const Vector3& centre, Eye eye) {
  const View view(eye);
  double most = 0;
  for (const Body* body : bodies) {
    for (const auto& point : body->mesh.points) {
      const Vector3 place = point - centre;
      most = std::max({most, std::abs(dot(place, view.right)), std::abs(dot(place, view.up))});
    }
  }
  return 2 * most;
}

RgbImage render(const std::vector<const Body*>& bodies, const Vector3& centre, double side, Eye eye, int pixels) {
  const View view(eye);
  const int size = pixels * supersample;
  const double scale = size / side;
  Screen screen(size);
  for (int b = 0; b < count_of(bodies); ++b) {
    const model::TriangleSoup& mesh = bodies[b]->mesh;
    std::vector<Corner> corners(mesh.points.size());
    std::transform(mesh.points.begin(), mesh.points.end(), corners.begin(), [&](const auto& point) -> Corner {
      const Vector3 place = point - centre;
      return {0.5 * size + scale * dot(place, view.right), 0.5 * size - scale * dot(place, view.up),
              dot(place, view.towards)};
    });
    for (int t = 0; t < count_of(mesh.triangles); ++t) {
      const auto& at = mesh.triangles[t];
      screen.draw({corners[at[0]], corners[at[1]], corners[at[2]]}, b, t);
    }
  }
  return reduced(lit(screen.seen(), bodies, view, size));
}

}  // namespace vam::plot
