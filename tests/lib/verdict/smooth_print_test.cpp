// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/private/smooth_print.hpp"

#include "testing.hpp"

namespace {

constexpr int size = 12;  // voxels along each axis
constexpr double threshold = 0.5;
constexpr float little = 0.505F;  // 1 % above it
constexpr float more = 0.515F;    // 3 %

using Field = std::function<float(int x, int y, int z)>;

/// In passes of so many slices.
std::vector<float> smoothed(const Field& coverage, const Field& dose, int pass) {
  std::vector<float> part, light;
  for (int n = 0; n < size * size * size; ++n) {
    const int x = n % size, y = n / size % size, z = n / size / size;
    part.push_back(coverage(x, y, z));
    light.push_back(dose(x, y, z));
  }
  vam::verdict::SmoothPrint print(size, size, threshold);
  std::vector<float> all;
  for (int first = 0; first < size; first += pass) {
    const int count = std::min(pass, size - first);
    const std::size_t at = static_cast<std::size_t>(first) * size * size;
    const auto some = print.add(count, part.data() + at, light.data() + at);
    all.insert(all.end(), some.begin(), some.end());
  }
  const auto rest = print.rest();
  all.insert(all.end(), rest.begin(), rest.end());
  return all;
}

float at(const std::vector<float>& field, int x, int y, int z) {
  return field[(static_cast<std::size_t>(z) * size + static_cast<std::size_t>(y)) * size + static_cast<std::size_t>(x)];
}

bool same(float a, double b) { return a == doctest::Approx(b).epsilon(1e-6); }

}  // namespace

TEST_CASE("a little dose beside an oblique face is roughness, more is not") {
  const Field half_space = [](int x, int y, int z) { return 2 * x + y + 3 * z < 33 ? 1.0F : 0.0F; };
  const auto print = [&](float bump, int pass) {
    const Field dose = [&](int x, int y, int z) {
      const int beyond = 2 * x + y + 3 * z - 33;
      if (beyond < 0) return beyond == -1 ? 0.495F : 1.0F;
      return beyond == 0 ? bump : 0.1F;
    };
    return smoothed(half_space, dose, pass);
  };
  for (const int pass : {1, 2, 5, size}) {
    CAPTURE(pass);
    const auto little_ones = print(little, pass);
    REQUIRE(little_ones.size() == size * size * size);
    CHECK(same(at(little_ones, 3, 6, 7), 0.98 * threshold));  // void
    CHECK(same(at(little_ones, 3, 5, 7), 1.02 * threshold));  // part
    CHECK(at(little_ones, 3, 4, 7) == 1.0F);
    CHECK(at(print(more, pass), 3, 6, 7) == more);
  }
}

TEST_CASE("in gaps and walls of two voxels a little dose decides, in those of three it does not") {
  for (const int width : {1, 2, 3}) {
    CAPTURE(width);
    const auto between = [&](int x) { return x >= 5 && x < 5 + width; };
    const auto field = [&](float inside, float outside) {
      return [=](int x, int, int) { return between(x) ? inside : outside; };
    };
    const auto bridge = smoothed(field(0, 1), field(little, 1), 4);
    CHECK(same(at(bridge, 5, 6, 6), width < 3 ? 1.01 * threshold : 0.98 * threshold));
    const auto pierced = smoothed(field(1, 0), field(0.495F, 0.1F), 4);
    CHECK(same(at(pierced, 5, 6, 6), width < 3 ? 0.99 * threshold : 1.02 * threshold));
  }
}

TEST_CASE("a firm dose is as the part has it within 2 % of the threshold") {
  CHECK(same(vam::verdict::firm_dose(1, 0.495F, threshold), 0.51));
  CHECK(same(vam::verdict::firm_dose(0.4F, 0.505F, threshold), 0.49));
  CHECK(vam::verdict::firm_dose(1, 0.48F, threshold) == 0.48F);
  CHECK(vam::verdict::firm_dose(0, 0.52F, threshold) == 0.52F);
}

TEST_CASE("2 % of the dose decide on no voxel wholly in part or void") {
  CHECK(same(vam::verdict::other_dose(0.98, 0.3F, 0.505F, threshold), 0.4949));
  CHECK(same(vam::verdict::other_dose(0.98, 1, 0.6F, threshold), 0.588));
  CHECK(vam::verdict::other_dose(0.98, 1, 0.505F, threshold) == 0.505F);
  CHECK(same(vam::verdict::other_dose(1.02, 0.3F, 0.495F, threshold), 0.5049));
  CHECK(same(vam::verdict::other_dose(1.02, 0, 0.4F, threshold), 0.408));
  CHECK(vam::verdict::other_dose(1.02, 0, 0.495F, threshold) == 0.495F);
}
