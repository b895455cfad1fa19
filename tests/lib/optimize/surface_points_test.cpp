// SPDX-License-Identifier: GPL-3.0-or-later
// Points of the design's surface: where they lie, what their doses cost, and that prints come out to size.
#include "optimize/methods/private/surface_points.hpp"

#include <iterator>

#include "lib/optimize/parts.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;

namespace {

constexpr int size = 40;
constexpr int slices = 36;  // of three slabs, the last one not full
constexpr double radius = 13.3;
using Point = std::array<double, 3>;  // in voxels from the middle of the ball

double from_middle(double x, double y, double z) { return std::hypot(x - 20.3, y - 18.9, z - 17.6); }

/// Coverage of voxels by a ball, 6 samples along each axis.
std::vector<float> ball() {
  constexpr int samples = 6;
  std::vector<float> values;
  for (const auto [z, y, x] : indices(slices, size, size)) {
    int inside = 0;
    for (int n = 0; n < samples * samples * samples; ++n) {
      const auto at = [&](int i) { return (i % samples + 0.5) / samples - 0.5; };
      inside += from_middle(x + at(n), y + at(n / samples), z + at(n / samples / samples)) < radius ? 1 : 0;
    }
    values.push_back(static_cast<float>(inside) / (samples * samples * samples));
  }
  return values;
}

Problem problem_of(const std::vector<float>& volume, const Demands& demands, const float* weight = nullptr,
                   bool stacked = true) {
  return parts::make_problem(volume.data(), slices, size, size, parts::circle(size), demands, weight, nullptr, stacked);
}

double distance(const SurfacePoint& p) {
  const auto at = [](SurfacePoint::Voxel v) {
    const int pixel = static_cast<int>(v.i) / lanes;
    const int row = pixel / size;
    return Point{static_cast<double>(pixel % size), static_cast<double>(row),
                 static_cast<double>(v.slab) * lanes + v.i % lanes};
  };
  const Point a = at(p.from);
  const Point b = at(p.to);
  const auto share = static_cast<double>(p.share);
  const auto mix = [&](int i) { return (1 - share) * a[i] + share * b[i]; };
  return from_middle(mix(0), mix(1), mix(2)) - radius;
}

std::vector<Slab> noise(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<Slab> doses = slabs(count, size, size);
  for (Slab& slab : doses) std::generate(slab.values.begin(), slab.values.end(), [&] { return uniform(random); });
  return doses;
}

}  // namespace

TEST_CASE("the foot of a thin wall has points on both sides where the block's face passes through its slice") {
  constexpr int face = 10;
  constexpr int wall = 20;  // and the column beside it
  std::vector<float> volume(slices * size * size, 0.0F);
  for (int z = 0; z <= 15; ++z) {
    for (int y = 10; y < 30; ++y) {
      for (int x = 10; x < 30; ++x) {
        const bool in_wall = x == wall || x == wall + 1;
        const float beside = z == face ? 0.2F : 0.0F;
        volume[(z * size + y) * size + x] = z < face ? 1.0F : in_wall ? 0.6F : beside;
      }
    }
  }
  const SurfacePoints surface(problem_of(volume, {}));
  const auto beside = [&](int x, int z) {
    return std::count_if(surface.points().begin(), surface.points().end(), [&](const SurfacePoint& p) {
      const auto is = [&](SurfacePoint::Voxel v, int at) {
        return static_cast<int>(v.slab) == z / lanes && static_cast<int>(v.i) == (20 * size + at) * lanes + z % lanes;
      };
      return (is(p.from, x) && is(p.to, x + 1)) || (is(p.from, x + 1) && is(p.to, x));
    });
  };
  for (const int z : {face, face + 1}) {
    CHECK(beside(wall - 1, z) == 1);
    CHECK(beside(wall + 1, z) == 1);
  }
  for (const SurfacePoint& p : surface.points()) CHECK(std::abs(p.cosine) > 0.1F);
}

TEST_CASE("points lie on the surface, at least one for every 1.75 voxel faces of it") {
  const SurfacePoints surface(problem_of(ball(), {}));
  double sum = 0;
  for (const SurfacePoint& p : surface.points()) {
    CHECK(std::abs(distance(p)) < 0.15);
    sum += distance(p);
  }
  const auto count = static_cast<double>(surface.points().size());
  // Columns of voxels are one wide: they do not see how a ball bends within them, nor where it leaves by their side.
  CHECK(std::abs(sum / count) < 0.02);
  const double area = 4 * std::numbers::pi * radius * radius;
  CHECK(count > area / std::sqrt(3.0));  // a surface at 45 degrees to all axes
  CHECK(count < area);
}

TEST_CASE("a flat face between the layers of voxels is found where it is") {
  for (const float covered : {0.1F, 0.4F, 0.6F, 0.9F}) {
    CAPTURE(covered);
    std::vector<float> block(static_cast<std::size_t>(slices) * size * size, 0.0F);
    for (int z = 10; z < 20; ++z) {
      for (int i = 15; i < 25; ++i) {
        for (int j = 15; j < 25; ++j) block[(z * size + i) * size + j] = j == 24 ? covered : 1.0F;
      }
    }
    int faces = 0;
    const SurfacePoints surface(problem_of(block, {}));
    for (const SurfacePoint& p : surface.points()) {
      const auto x = static_cast<int>(p.from.i / lanes % size);
      if (x != 23 && x != 24) continue;
      if (p.to.i != p.from.i + lanes) continue;  // of another face
      ++faces;
      CHECK(static_cast<float>(x) + p.share == doctest::Approx(23.5F + covered));
    }
    CHECK(faces >= 8 * 8);
  }
}

TEST_CASE("a slice that is not stacked has the points that it has alone, whatever lies beside it") {
  const std::vector<float> volume = ball();
  const auto slice = [&](int z) {
    return std::vector<float>(volume.begin() + z * size * size, volume.begin() + (z + 1) * size * size);
  };
  const auto mirrored = [&](int z) {
    std::vector<float> values = slice(z);
    std::reverse(values.begin(), values.end());
    return values;
  };
  const std::vector<std::vector<float>> pass{slice(17), mirrored(13), slice(0), slice(28), mirrored(26)};
  const auto packed = parts::stacked(pass);
  const auto points_of = [](const std::vector<float>& slices, int count) {
    return SurfacePoints(parts::make_problem(slices.data(), count, size, size, parts::circle(size), {})).points();
  };
  const std::vector<SurfacePoint> all = points_of(packed, 5);
  for (std::uint32_t k = 0; k < 5; ++k) {
    CAPTURE(k);
    std::vector<SurfacePoint> here;
    std::copy_if(all.begin(), all.end(), std::back_inserter(here), [&](const SurfacePoint& p) {
      CHECK(p.from.i % lanes == p.to.i % lanes);
      return p.from.i % lanes == k;
    });
    const std::vector<SurfacePoint> alone = points_of(pass[k], 1);
    CHECK(alone.empty() == (k == 2));
    REQUIRE(here.size() == alone.size());
    for (std::size_t n = 0; n < alone.size(); ++n) {
      CHECK(here[n].from.i - k == alone[n].from.i);
      CHECK(here[n].to.i - k == alone[n].to.i);
      CHECK(here[n].share == alone[n].share);
      CHECK(here[n].cosine == alone[n].cosine);
    }
  }
}

TEST_CASE("a part that reaches the border of its grid has as many points as its mirror images") {
  const std::array<int, 3> counts{9, 7, 5};
  const Circle wide{4, 3, 20};
  const auto points = [&](int wall, int mirrored) {  // a block from `wall` to the border along each axis
    std::vector<float> volume;
    for (const auto [z, y, x] : indices(counts[2], counts[1], counts[0])) {
      std::array<int, 3> at{x, y, z};
      if (mirrored >= 0) at[mirrored] = counts[mirrored] - 1 - at[mirrored];
      volume.push_back(at[0] >= wall && at[1] >= wall && at[2] >= wall ? 1.0F : 0.0F);
    }
    const Problem problem =
        parts::make_problem(volume.data(), counts[2], counts[0], counts[1], wide, {}, nullptr, nullptr, true);
    return SurfacePoints(problem).points().size();
  };
  const std::size_t as_is = points(2, -1);
  // Of the faces of 5 x 3, 7 x 3 and 7 x 5 voxels, all but some at their edges.
  CHECK(as_is > 4 * 2 + 6 * 2 + 6 * 4);
  for (const int axis : {0, 1, 2}) CHECK(points(2, axis) == as_is);
}

TEST_CASE("a grid of one column has points, too") {
  const std::vector<float> column{0, 1, 1, 0, 0};
  const auto points = [&](int width, int height) {
    return SurfacePoints(parts::make_problem(column.data(), 1, width, height, {2, 2, 20}, {})).points().size();
  };
  CHECK(points(5, 1) == 2);
  CHECK(points(1, 5) == 2);
}

TEST_CASE("slopes are the transpose of misses, and the derivative of the losses") {
  const Problem problem = problem_of(ball(), {});
  const SurfacePoints surface(problem);
  const std::vector<Slab> dose = noise(problem.target.size());
  const std::vector<float> misses = surface.misses(dose);
  std::vector<Slab> slopes = slabs(dose.size(), size, size);
  surface.add_slopes(misses, slopes);
  double along = 0;  // <dose, slopes> = 1/4 <misses + threshold, misses>
  for (std::size_t s = 0; s < dose.size(); ++s) {
    for (std::size_t i = 0; i < dose[s].values.size(); ++i) {
      along += static_cast<double>(dose[s].values[i]) * static_cast<double>(slopes[s].values[i]);
    }
  }
  double expected = 0;
  double loss = 0;
  for (const float miss : misses) expected += (static_cast<double>(miss) + 0.8) * static_cast<double>(miss);
  for (const auto& lane : surface.losses(misses, dose.size())) {
    for (const float v : lane) loss += static_cast<double>(v);
  }
  CHECK(along == doctest::Approx(expected).epsilon(1e-5));
  double half_squares = 0;
  for (const float miss : misses) half_squares += 0.5 * static_cast<double>(miss) * static_cast<double>(miss);
  CHECK(loss == doctest::Approx(half_squares).epsilon(1e-5));
}

TEST_CASE("a voxel that the surface cuts costs something only on the wrong side of the threshold") {
  std::vector<float> volume(static_cast<std::size_t>(slices) * size * size, 0.0F);
  const std::size_t more = (5 * size + 20) * size + 20;
  const std::size_t less = more + 4;
  for (int x = 5; x < 12; ++x) volume[(5 * size + 20) * size + x] = 1.0F;
  volume[more] = 0.6F;
  volume[less] = 0.4F;
  const Problem problem = problem_of(volume, {});
  const SurfacePoints surface(problem);
  const auto costs = [&](float dose) {
    std::vector<Slab> doses = slabs(problem.target.size(), size, size);
    for (Slab& slab : doses) std::fill(slab.values.begin(), slab.values.end(), dose);
    const std::vector<float> misses = surface.misses(doses);
    return std::vector<float>(misses.end() - 2, misses.end());
  };
  CHECK(costs(0.7F)[0] == doctest::Approx(-0.1F));
  CHECK(costs(0.7F)[1] == 0);
  CHECK(costs(0.95F)[0] == 0);
  CHECK(costs(0.95F)[1] == doctest::Approx(0.15F));
}

TEST_CASE("the surface is constrained only where it is neither free nor constrained otherwise") {
  const std::vector<float> volume = ball();
  const auto count = [&](const Demands& demands, const float* weight, bool stacked) {
    const Problem problem = problem_of(volume, demands, weight, stacked);
    const SurfacePoints surface(problem);
    if (surface.points().empty()) CHECK(surface.misses(noise(problem.target.size())).empty());
    return surface.points().size();
  };
  const std::size_t all = count({}, nullptr, true);
  CHECK(count({}, nullptr, false) > all / 2);
  Demands demands{.free_surface = true};
  CHECK(count(demands, nullptr, true) == 0);
  demands = {};
  demands.surface = true;
  CHECK(count(demands, nullptr, true) == 0);
  demands = {};
  demands.grey = true;
  CHECK(count(demands, nullptr, true) == 0);
  std::vector<float> weight(volume.size(), 1.0F);
  for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = i % size < 20 ? 0.0F : 1.0F;
  const std::size_t half = count({}, weight.data(), true);
  CHECK(half > 0.4 * static_cast<double>(all));
  CHECK(half < 0.6 * static_cast<double>(all));
}

TEST_CASE("apg brings the dose on the surface to the threshold, in light that is limited, too") {
  const auto parts = std::vector{vam::oracle::wheel(96), vam::oracle::disc_grid(96, 0.6)};
  const auto light = parts::parallel_light(96, 180);
  const auto all = parts::stacked(parts);
  // Root mean square of dose - threshold on the surface.
  const auto missed = [&](bool free, double max_intensity) {
    Demands demands;
    const auto asked = parts::make_problem(all.data(), 2, 96, 96, parts::circle(96), demands);
    demands.free_surface = free;
    const auto problem = parts::make_problem(all.data(), 2, 96, 96, parts::circle(96), demands);
    MethodOptions options{.max_intensity = max_intensity};
    Iterate state;
    run_method(*make_method("apg", options), problem, *light, {.iterations = 25, .until = {}, .patience = 0}, state);
    const SurfacePoints surface(asked);
    auto misses = surface.misses(state.dose);
    misses.resize(surface.points().size());
    double squares = 0;
    for (const float miss : misses) squares += static_cast<double>(miss) * static_cast<double>(miss);
    return std::sqrt(squares / static_cast<double>(misses.size()));
  };
  for (const double limit : {0.0, 0.3}) {
    CAPTURE(limit);
    const double free = missed(true, limit);
    const double asked = missed(false, limit);
    MESSAGE("free " << free << ", asked " << asked);
    CHECK(asked < 0.5 * free);
  }
}
