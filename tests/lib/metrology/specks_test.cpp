// SPDX-License-Identifier: GPL-3.0-or-later
// Specks are told from bubbles that stay long, and rays that they hide at both ends are filled.
#include "metrology/ost/private/specks.hpp"

#include "base/index.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

constexpr int columns = 101;
constexpr int angles = 120;
constexpr int heights = 30;

// A cylinder beside the axis, of all heights.
std::vector<Image> cylinder() {
  std::vector<Image> out(heights, Image(columns, angles));
  for (Image& s : out) {
    for (const auto [a, t] : indices(angles, columns)) {
      const double off = t - 0.5 * (columns - 1) - 8 * std::cos(2 * std::numbers::pi * a / angles);
      s(t, a) = static_cast<float>(std::sqrt(std::max(0.0, 900 - off * off)) / 30);
    }
  }
  return out;
}

void add_spot(std::vector<Image>& sinograms, int angle, double t, double k, double radius, float bright) {
  for (const auto [j, x] : indices(heights, columns)) {
    if (std::hypot(x - 0.5 * (columns - 1) - t, j - k) <= radius) sinograms[j](x, angle) += bright;
  }
}

void add_speck(std::vector<Image>& sinograms, double t, double k, double radius, float bright) {
  for (int a = 0; a < angles; ++a) add_spot(sinograms, a, t, k, radius, bright);
}

float largest_difference(const std::vector<Image>& a, const std::vector<Image>& b) {
  float most = 0;
  for (int k = 0; k < heights; ++k) {
    for (std::size_t i = 0; i < a[k].size(); ++i) most = std::max(most, std::abs(a[k].values[i] - b[k].values[i]));
  }
  return most;
}

bool is_hidden(const RayMask& specks, int t, int k) { return specks[product(k, columns) + (columns - 1) / 2 + t] != 0; }

}  // namespace

TEST_CASE("faint specks are found where bubbles pass slowly, which are none") {
  auto sinograms = cylinder();
  add_speck(sinograms, 20, 12, 2, 0.1F);
  for (int bubble = 0; bubble < 5; ++bubble) {  // each for a fifth of the turn
    for (int a = 0; a < angles / 5; ++a) {
      add_spot(sinograms, (a + 20 * bubble) % angles, 8.0 * bubble + 5, 0.3 * a + 5.0 * bubble, 4, 2);
    }
  }
  const RayMask specks = speck_rays(sinograms);
  CHECK(is_hidden(specks, 20, 12));
  CHECK(share_of(specks) < 0.027);  // a square of 9 x 9, with the rim of two pixels
}

TEST_CASE("of clean views nothing is a speck") { CHECK(share_of(speck_rays(cylinder())) == 0); }

TEST_CASE("a speck is replaced by the other ends of its lines") {
  const auto clean = cylinder();
  auto sinograms = clean;
  add_speck(sinograms, 20, 12, 2, 0.5F);
  replace_specks(speck_rays(sinograms), sinograms);
  CHECK(largest_difference(sinograms, clean) < 1e-4F);
}

TEST_CASE("specks at both ends of a line, and one on the axis, are filled from around them") {
  const auto clean = cylinder();
  for (const double t : {0.3, 10.0}) {
    CAPTURE(t);
    auto sinograms = clean;
    add_speck(sinograms, t, 12, 2.5, 0.5F);
    if (t > 1) add_speck(sinograms, -t, 15, 2.5, 0.5F);
    const RayMask specks = speck_rays(sinograms);
    replace_specks(specks, sinograms);
    CHECK(largest_difference(sinograms, clean) < 0.05F);  // a tenth of the speck: edges curve across it
  }
}

TEST_CASE("what is near a bubble beside a speck is near it behind, too") {
  RayMask specks(columns * heights, 0);
  for (int k = 10; k < 15; ++k) {
    for (int t = 70; t < 75; ++t) specks[product(k, columns) + t] = 1;
  }
  std::vector<RayMask> marked(2, RayMask(columns * heights, 0));
  marked[0][product(12, columns) + 75] = 1;
  propagate_mask(specks, columns, marked);
  CHECK(marked[0][product(12, columns) + 70] == 1);
  CHECK(marked[0][product(11, columns) + 70] == 0);
  CHECK(share_of(marked[1]) == 0);
  marked[1][product(12, columns) + columns - 1 - 75] = 1;  // beside the other ends of its lines
  propagate_mask(specks, columns, marked);
  CHECK(marked[1][product(12, columns) + columns - 1 - 70] == 1);
}
