// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>

#include "base/index.hpp"
#include "metrology/ost/private/hidden_rays.hpp"
#include "metrology/ost/private/one_density_body.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

constexpr int columns = 81;
constexpr int angles = 120;
constexpr int heights = 48;
constexpr double voxel_mm = 0.1;
constexpr double radius_mm = 2.5;
constexpr double tall_mm = 1.5;  // half of it
constexpr float any = std::numeric_limits<float>::infinity();

model::Grid grid() { return model::centred_grid(columns, columns, heights, voxel_mm, -0.5 * (heights - 1) * voxel_mm); }

// A camera 100 mm away, level with the middle.
ClimbingRays climbing() {
  return {columns, angles, std::vector<double>(columns, 0.01), 0, std::numbers::pi / angles / voxel_mm};
}

// Of the ray u -> z (1 + rate u) in an upright cylinder at (x_mm, y_mm).
double chord_mm(double t_mm, double theta, double z_mm, double x_mm, double y_mm, double radius) {
  const double off = t_mm - x_mm * std::cos(theta) - y_mm * std::sin(theta);
  if (std::abs(off) >= radius) return 0;
  const double middle = y_mm * std::cos(theta) - x_mm * std::sin(theta);
  const double half = std::sqrt(radius * radius - off * off);
  double from = middle - half;
  double to = middle + half;
  if (z_mm != 0) to = std::min(to, (tall_mm / std::abs(z_mm) - 1) / 0.01);
  return std::max(0.0, to - from);
}

// Columns have the mean of five rays.
std::vector<Image> sinograms_of(double x_mm, double y_mm, double radius, double density) {
  const model::Grid g = grid();
  std::vector<Image> out(heights, Image(columns, angles));
  for (const auto [k, a, t] : indices(heights, angles, columns)) {
    for (const double part : {-0.4, -0.2, 0.0, 0.2, 0.4}) {
      const double t_mm = (t + part - 0.5 * (columns - 1)) * voxel_mm;
      const double theta = 2 * std::numbers::pi * a / angles;
      out[k](t, a) += static_cast<float>(0.2 * density * chord_mm(t_mm, theta, g.z_mm(k), x_mm, y_mm, radius));
    }
  }
  return out;
}

BodyPaths bodies_of(const std::vector<Image>& sinograms, float dark) {
  return {climbing(), one_density_body(climbing(), grid(), sinograms, dark)};
}

// The same spot of light at both ends of some lines.
void add_twin_bubbles(std::vector<Image>& sinograms) {
  for (int a = 20; a < 26; ++a) {
    for (int k = 20; k < 29; ++k) {
      for (int t = 46; t < 55; ++t) {
        const double square = std::pow(k - 24, 2) + std::pow(t - 50, 2);
        const auto light = static_cast<float>(3 * std::sqrt(std::max(0.0, 1 - square / 20)));
        sinograms[k](t, a) += light;
        sinograms[k](columns - 1 - t, a + angles / 2) += light;
      }
    }
  }
}

float largest_difference(const std::vector<Image>& a, const std::vector<Image>& b) {
  float most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (std::size_t i = 0; i < a[k].size(); ++i) most = std::max(most, std::abs(a[k].values[i] - b[k].values[i]));
  }
  return most;
}

}  // namespace

TEST_CASE("rays pass of the bodies what made them, at end faces, too") {
  const auto sinograms = sinograms_of(0.4, -0.3, radius_mm, 2);
  const BodyPaths bodies = bodies_of(sinograms, 0.15F);
  std::vector<float> passed(heights);
  for (const int a : {0, 17, 60, 95}) {
    for (const int t : {25, 40, 50}) {
      bodies.along(t, a, 0, 1, passed);
      for (int k = 0; k < heights; ++k) {
        CAPTURE(a);
        CAPTURE(t);
        CAPTURE(k);
        const double face_mm = std::abs(std::abs(grid().z_mm(k)) - tall_mm);
        if (face_mm < 0.08) continue;  // of the body, which is cut between voxels
        CHECK(passed[k] == doctest::Approx(sinograms[k](t, a)).epsilon(0.03).scale(2));
      }
    }
  }
}

TEST_CASE("bubbles that are alike at both ends of a line are found, and the bodies' light restored") {
  const auto clean = sinograms_of(0.4, -0.3, radius_mm, 2);
  auto bubbly = clean;
  add_twin_bubbles(bubbly);
  constexpr float least = 0.6F;
  const BodyPaths bodies = bodies_of(bubbly, 0.5F * least);
  const std::vector<RayMask> none(angles);
  const auto above = rays_above(bodies, bubbly, none, 10000, least).value();
  CHECK(above[22][product(24, columns) + 50] == 1);
  CHECK(above[40].empty());
  auto restored = bubbly;
  std::vector<RayMask> hidden = above;
  for (int a = 0; a < angles; ++a) {  // rays of the other ends
    RayMask far = above[(a + angles / 2) % angles];
    for (auto row = far.begin(); row != far.end(); row += columns) std::reverse(row, row + columns);
    if (!far.empty()) hidden[a] = far;
  }
  limit_to_bodies(bodies, hidden, least, any, bubbly, restored);
  CHECK(largest_difference(bubbly, clean) > 2.9F);
  CHECK(largest_difference(restored, clean) < 2 * least);
  // More of them than are asked for are none.
  CHECK(!rays_above(bodies, bubbly, none, 10, least));
}

TEST_CASE("a bubble that was not seen beside a hidden ray does not count") {
  const auto clean = sinograms_of(0, 0, 1.5, 2);
  auto bubbly = clean;
  std::vector<RayMask> hidden(angles);
  const std::size_t ray = product(24, columns) + 50;
  for (int a = 20; a < 30; ++a) {  // hidden but for the first and last two angles
    bubbly[24](50, a) += 3;
    if (a < 22 || a > 27) continue;
    hidden[a] = RayMask(product(heights, columns), 0);
    hidden[a][ray] = 1;
  }
  constexpr float least = 0.3F;
  const BodyPaths bodies = bodies_of(clean, least);
  auto restored = bubbly;
  limit_to_bodies(bodies, hidden, least, any, bubbly, restored);
  CHECK(restored[24](50, 25) > clean[24](50, 25) + 2);  // believed to be light of another density
  limit_to_bodies(bodies, hidden, least, least, bubbly, restored);
  CHECK(std::abs(restored[24](50, 25) - clean[24](50, 25)) < 2 * least);
}

TEST_CASE("of a body of lesser density nothing is taken where no bubble is") {
  auto sinograms = sinograms_of(0, 0, 2, 2);
  const auto faint = sinograms_of(2.9, 0, 0.6, 0.8);
  for (int k = 0; k < heights; ++k) {
    for (std::size_t i = 0; i < faint[k].size(); ++i) sinograms[k].values[i] += faint[k].values[i];
  }
  const auto before = sinograms;
  const BodyPaths bodies = bodies_of(sinograms, 0.15F);
  std::vector<RayMask> hidden(angles);
  for (int a = 30; a < 33; ++a) hidden[a] = RayMask(product(heights, columns), 1);
  limit_to_bodies(bodies, hidden, 0, any, before, sinograms);
  CHECK(largest_difference(sinograms, before) < 0.48F);  // half of its light
}

TEST_CASE("what bubbles leave beside the print is no body: other rays are dark there") {
  const auto clean = sinograms_of(0, 0, 1.5, 2);
  auto bubbly = clean;
  // A place beside it that is bright for a third of a turn, from both ends.
  for (int a = 0; a < angles; ++a) {
    if (a % (angles / 2) >= angles / 6) continue;
    const double theta = 2 * std::numbers::pi * a / angles;
    for (int k = 20; k < 29; ++k) {
      for (int t = 0; t < columns; ++t) {
        const double off = t - 0.5 * (columns - 1) - 30 * std::cos(theta);
        if (std::abs(off) < 4) bubbly[k](t, a) += 3;
      }
    }
  }
  const auto along = [&](float dark) {
    const BodyPaths bodies = bodies_of(bubbly, dark);
    float passed = 0;
    bodies.along(columns / 2 + 30, 0, 24, 1, std::span(&passed, 1));
    return passed;
  };
  CHECK(along(0) > 0.5F);
  CHECK(along(0.3F) < 0.1F);
}
