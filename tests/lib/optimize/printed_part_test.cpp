// SPDX-License-Identifier: GPL-3.0-or-later
// trials: 6 -tc=test parts print*
#include "lib/optimize/printed_part.hpp"

#include <set>

#include "testing.hpp"
#include "trials.hpp"

using parts::judge;
using parts::make_light;

namespace {

float peak(const parts::Light& light) {
  float most = 0;
  for (const auto& image : light.sinograms) {
    most = std::max(most, *std::max_element(image.values.begin(), image.values.end()));
  }
  return most;
}

/// In no more time than another light of that peak takes to print.
parts::Light clipped(parts::Light light, float most) {
  for (auto& image : light.sinograms) {
    for (float& v : image.values) v = std::min(v, most);
  }
  return light;
}

}  // namespace

// The table of tests/bench/printability at an eighth of its voxels: of its six shapes two, all in ctest --preset long.
TEST_CASE("test parts print under method auto, judged by chief rays, and no worse than by other ways, limited or not") {
  const vam::model::Printer printer;
  const std::set<std::string> judged_as_resampled{"gyroid", "boat"};
  for (const auto& shape : parts::printed_shapes()) {
    if (trials_or(1) == 1 && judged_as_resampled.count(shape) == 0) continue;
    CAPTURE(shape);
    const parts::Part part = parts::make_part(shape, 64);
    const auto light = make_light(part, printer, 180, "auto", false);
    const auto best = judge(part, printer, light);
    CHECK(best.ver <= 1e-4);
    CHECK(best.iou >= 0.995);
    const auto slow = judge(part, printer, make_light(part, printer, 180, "auto", false, false));
    for (const char* method : {"fbp", "dose-norm"}) {
      CAPTURE(method);
      const auto simple = make_light(part, printer, 180, method, false);
      const auto beats = [](const auto& ours, const auto& theirs, double spared = 0) {
        CHECK(ours.ver <= theirs.ver);
        CHECK(ours.pw >= theirs.pw - spared);
        CHECK(ours.iou >= theirs.iou);
      };
      beats(slow, judge(part, printer, simple));
      constexpr double surface = 0.01;  // of the window, at most, is what asking for the surface may cost
      beats(best, judge(part, printer, clipped(simple, peak(light))), surface);
    }
    if (judged_as_resampled.count(shape) == 0) continue;
    const auto resampled = judge(part, printer, make_light(part, printer, 180, "auto", true));
    CHECK(best.pw > resampled.pw + 0.01);
    CHECK(best.ver <= resampled.ver);
  }
}
