// SPDX-License-Identifier: GPL-3.0-or-later
// trials: 20 -tc=where bubbles pass*
// Run-out of the vial, seen by an independent renderer: fitted with deviations that hold, and removed.
#include "metrology/ost/run_out.hpp"

#include "lib/metrology/bench_printer.hpp"
#include "metrology/cure/bodies.hpp"
#include "metrology/ost/ost.hpp"
#include "oracle/bench_views.hpp"
#include "solid/mesh/surface_samples.hpp"
#include "solid/voxel/isosurface.hpp"
#include "testing.hpp"
#include "trials.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

using Kind = oracle::Body::Kind;

std::vector<CameraView> seen(const oracle::ViewBench& bench, const std::vector<oracle::Body>& bodies, double noise,
                             unsigned seed, int count = 180) {
  auto pixels = oracle::bench_views(bench, bodies, {}, count);
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, static_cast<float>(noise));
  float peak = 0;
  for (const auto& view : pixels) peak = std::max(peak, *std::max_element(view.begin(), view.end()));
  std::vector<CameraView> views;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    Image image(bench.columns, bench.rows);
    image.values = pixels[i];
    if (noise > 0) {
      for (float& v : image.values) v += peak * normal(random);
    }
    views.push_back({std::move(image), 360.0 * static_cast<double>(i) / static_cast<double>(pixels.size())});
  }
  return views;
}

oracle::ViewBench coarse_bench() {
  return {.columns = 160, .rows = 96, .pixel_mm = 0.15, .axis_column = 79.5, .axis_row = 47.5, .rays = 2};
}

// A post with a hole, two blocks beside the axis.
std::vector<oracle::Body> random_part(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto within = [&](double low, double high) { return low + (high - low) * unit(random); };
  return {{Kind::cylinder, {within(-0.5, 0.5), within(-0.5, 0.5), 0}, {within(3, 4.5), 0, 6.2}, 1},
          {Kind::cylinder, {within(-1, 1), within(-1, 1), 0}, {within(0.6, 1.4), 0, 6.2}, -1},
          {Kind::block, {within(-2, 2), within(-2, 2), -3}, {within(0.5, 1.5), within(0.5, 1.5), 1.5}, 1},
          {Kind::block, {within(-4, 4), within(-4, 4), 1}, {within(0.5, 1), within(0.5, 1), 2}, 1}};
}

struct Deviations {
  double square = 0;
  int count = 0;
  void add(double error, double sigma) {
    square += error * error / (sigma * sigma);
    ++count;
  }
  [[nodiscard]] double rms() const { return std::sqrt(square / count); }
};

/// Its axis up to 3 px beside the middle, its run-out up to 0.12 mm anywhere.
oracle::ViewBench drawn_bench(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  oracle::ViewBench bench = coarse_bench();
  bench.rays = 1;
  bench.axis_column += 6 * (unit(random) - 0.5);
  const double size_mm = 0.12 * unit(random);
  const double towards = 2 * std::numbers::pi * unit(random);
  bench.run_out_mm = {size_mm * std::cos(towards), size_mm * std::sin(towards)};
  return bench;
}

RunOut found_in(const oracle::ViewBench& bench, const std::vector<CameraView>& views, const AxisPose& axis) {
  return OstReconstructor(printer_of(bench), bench.pixel_mm, bench.columns, bench.rows, axis,
                          {.axis_row = bench.axis_row})
      .find_run_out(views);
}

}  // namespace

TEST_CASE("run-out and axis deviate from the truth by as much as their standard deviations say") {
  Deviations run_out, with_run_out, alone, tilt;
  double worst_mm = 0;
  for (unsigned seed = 1; seed <= 16; ++seed) {
    std::mt19937 random(seed);
    oracle::ViewBench bench = drawn_bench(random);
    if (seed % 4 == 0) bench.lens_mm = 0;
    const double noise = 0.01 * (seed % 3 + 1);
    const auto views = seen(bench, random_part(random), noise, seed);
    const AxisEstimate axis = find_axis(mean_view(views));
    const RunOut found = found_in(bench, views, axis.pose);
    REQUIRE(found.determined);
    for (std::size_t i = 0; i < 2; ++i) {
      run_out.add(found.mm[i] - bench.run_out_mm[i], found.sigma_mm);
      worst_mm = std::max(worst_mm, std::abs(found.mm[i] - bench.run_out_mm[i]));
    }
    with_run_out.add(found.column - bench.axis_column, found.column_sigma);
    alone.add(axis.pose.column - bench.axis_column, axis.column_sigma);
    tilt.add(axis.pose.tilt_rad, axis.tilt_sigma_rad);
  }
  MESSAGE("normalised deviations: run-out ", run_out.rms(), ", column ", with_run_out.rms(), ", column from the mean ",
          alone.rms(), ", tilt ", tilt.rms(), "; worst run-out off by ", worst_mm, " mm");
  // 32 and 16 numbers of deviation 1 have an RMS of 1 +- 0.13 and 1 +- 0.18: within three of these, and for those that
  // know of no run-out not above.
  CHECK(run_out.rms() > 0.6);
  CHECK(run_out.rms() < 1.4);
  CHECK(with_run_out.rms() > 0.45);
  CHECK(with_run_out.rms() < 1.55);
  CHECK(alone.rms() < 1.55);
  CHECK(tilt.rms() < 1.55);
  CHECK(worst_mm < 0.015);  // a tenth of a pixel
}

TEST_CASE("the axis of ideal views has a standard deviation that its error does not exceed sevenfold") {
  Deviations column;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::mt19937 random(seed);
    const oracle::ViewBench bench = coarse_bench();
    const AxisEstimate axis = find_axis(mean_view(seen(bench, random_part(random), 0, seed)));
    column.add(axis.pose.column - bench.axis_column, axis.column_sigma);
  }
  MESSAGE("normalised deviation ", column.rms());
  CHECK(column.rms() < 3);  // of errors of a thousandth of a pixel
}

TEST_CASE("a clean cylinder beside the axis has no run-out") {
  const std::vector<oracle::Body> cylinder{{Kind::cylinder, {1, 0.5, 0}, {4, 0, 6.2}, 1}};
  for (const double lens_mm : {0.0, 100.0, 200.0}) {
    CAPTURE(lens_mm);
    oracle::ViewBench bench = coarse_bench();
    bench.lens_mm = lens_mm;
    const RunOut found = found_in(bench, seen(bench, cylinder, 0, 1), {bench.axis_column, 0});
    MESSAGE("run-out ", found.mm[0], " ", found.mm[1], " +- ", found.sigma_mm, " mm");
    CHECK(found.determined);
    CHECK(!found.seen());
    CHECK(found.size_mm() < 0.02 * bench.pixel_mm);  // blurred along the columns alone a tenth of a pixel of 0.05 mm
  }
}

TEST_CASE("a run-out of 0.1 mm is seen, and a print without it is as it is") {
  const std::vector<oracle::Body> post{{Kind::cylinder, {0, 0, 0}, {4.5, 0, 2.7}, 1},
                                       {Kind::cylinder, {1.5, 1, 0}, {1.2, 0, 2.7}, -1},
                                       {Kind::block, {5.2, 0.5, -1.3}, {0.9, 1.2, 0.7}, 1}};
  for (const double bath : {1.0, 1.4}) {
    CAPTURE(bath);
    oracle::ViewBench bench{.window_mm = bath > 1 ? 20.0 : 0.0,
                            .bath_index = bath,
                            .columns = 400,
                            .rows = 140,
                            .axis_column = 199.5,
                            .axis_row = 69.5,
                            .rays = 2,
                            .run_out_mm = {0.06, -0.08}};
    const auto views = seen(bench, post, 0, 1, 120);
    const AxisEstimate axis = find_axis(mean_view(views));
    const RunOut found = found_in(bench, views, axis.pose);
    MESSAGE("run-out ", found.mm[0], " ", found.mm[1], " +- ", found.sigma_mm, " mm");
    CHECK(found.seen());
    CHECK(std::abs(found.size_mm() - 0.1) < 0.01);
    const auto rms_mm = [&](RunOutVector run_out, double column) {
      const OstReconstructor rig(printer_of(bench), bench.pixel_mm, bench.columns, bench.rows, {column, 0},
                                 {.axis_row = bench.axis_row, .run_out_mm = run_out});
      model::Volume volume = rig.reconstruct(views);
      keep_bodies(volume, 0.5, {});
      double sum = 0;
      const auto samples = solid::sample_surface(solid::isosurface(volume, 0.5), 100000);
      for (const auto& s : samples) sum += std::pow(oracle::distance_mm(post, s.point), 2);
      return std::sqrt(sum / static_cast<double>(samples.size()));
    };
    const double removed = rms_mm(found.mm, found.column);
    MESSAGE("RMS ", removed, " mm without the run-out");
    CHECK(removed <= 0.01);  // as without run-out: a fifth of a voxel
    if (bath == 1) CHECK(rms_mm({}, axis.pose.column) > 2 * removed);
  }
}

TEST_CASE("a bath of the resin's index hides the run-out, and says so") {
  oracle::ViewBench bench = coarse_bench();
  bench.bath_index = bench.resin_index;
  bench.window_mm = 20;
  bench.run_out_mm = {0.1, 0};
  std::mt19937 random(1);
  const auto views = seen(bench, random_part(random), 0.01, 1);
  const RunOut found = found_in(bench, views, {bench.axis_column, 0});
  CHECK(!found.seen());
}

TEST_CASE("where bubbles pass, run-out and axis deviate by as much as their standard deviations say") {
  Deviations run_out, column, tilt;
  double worst_px = 0;
  const auto draws = static_cast<unsigned>(trials_or(8));
  for (unsigned seed = 1; seed <= draws; ++seed) {
    std::mt19937 random(seed);
    oracle::ViewBench bench = drawn_bench(random);
    const auto pixels = oracle::bench_views(bench, random_part(random), oracle::bubbles(15, 8, seed + 100), 180);
    const std::vector<CameraView> views = views_of(bench, pixels);
    const AxisEstimate axis = find_axis(views);
    column.add(axis.pose.column - bench.axis_column, axis.column_sigma);
    tilt.add(axis.pose.tilt_rad, axis.tilt_sigma_rad);
    worst_px = std::max(worst_px, std::abs(axis.pose.column - bench.axis_column));
    const RunOut found = found_in(bench, views, axis.pose);
    if (!found.determined) continue;
    for (std::size_t i = 0; i < 2; ++i) run_out.add(found.mm[i] - bench.run_out_mm[i], found.sigma_mm);
  }
  MESSAGE("normalised deviations: run-out ", run_out.rms(), " of ", run_out.count, ", column ", column.rms(), ", tilt ",
          tilt.rms(), "; worst column off by ", worst_px, " px");
  // n numbers of deviation 1 have an RMS of 1 +- 1 / sqrt(2 n): within three of these. For column and tilt of 8 draws
  // that is 0.25 to 1.75, which notices more often than not a standard deviation of half or of four times the errors'
  // own; for the 20 draws of ctest --preset long it is 0.53 to 1.47.
  const auto is_one = [](const Deviations& found) {
    return std::abs(found.rms() - 1) < 3 / std::sqrt(2.0 * found.count);
  };
  CHECK(run_out.count >= static_cast<int>(1.6 * draws));  // of two a draw
  CHECK(is_one(run_out));
  CHECK(is_one(column));
  CHECK(is_one(tilt));
  CHECK(worst_px < 0.05);  // of the mean view 0.2, by residuals that pull with constant force 0.09
}

TEST_CASE("bubbles that turn with the vial are no run-out") {
  oracle::ViewBench bench = coarse_bench();
  bench.rays = 1;
  int pulled = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    const auto part = random_part(random);
    std::vector<oracle::Bubble> bubbles = oracle::bubbles(60, 8, seed);
    for (oracle::Bubble& bubble : bubbles) {
      bubble.carried = 1;
      bubble.rise_mm *= 0.1;  // so slowly that they err alike over the whole turn
    }
    const auto pixels = oracle::bench_views(bench, part, bubbles, 180);
    const std::vector<CameraView> views = views_of(bench, pixels);
    const RunOut found = found_in(bench, views, {bench.axis_column, 0});
    MESSAGE("run-out ", found.size_mm(), " +- ", found.sigma_mm, " mm, determined: ", found.determined);
    CHECK(!found.seen());
    pulled += !found.determined && found.size_mm() > 3.44 * found.sigma_mm ? 1 : 0;
  }
  CHECK(pulled > 0);  // the fit alone would have been believed
}

TEST_CASE("absorption that is not given is no run-out, and is seen") {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    oracle::ViewBench bench = coarse_bench();
    const auto part = random_part(random);
    const double noise = 0.005 * (seed % 3);
    const auto found_at = [&](double absorption_per_mm, double run_out_mm) {
      bench.absorption_per_mm = absorption_per_mm;
      bench.run_out_mm = {run_out_mm, 0};
      oracle::ViewBench clear = bench;
      clear.absorption_per_mm = 0;
      return found_in(clear, seen(bench, part, noise, seed, 90), {bench.axis_column, 0});
    };
    const RunOut absorbed = found_at(0.1, 0);
    MESSAGE("absorption ", absorbed.absorption_per_mm, " +- ", absorbed.absorption_sigma_per_mm, " per mm");
    CHECK(!absorbed.seen());
    CHECK(absorbed.absorbs());
    CHECK(std::abs(absorbed.absorption_per_mm - 0.1) < 0.03);  // of what absorption has weakened, to the first order
    const RunOut clear = found_at(0, 0.1);
    CHECK(clear.seen());
    CHECK(!clear.absorbs());
  }
}

TEST_CASE("where the absorption is given the run-out is found beside it, and none where there is none") {
  for (const double absorption_per_mm : {0.02, 0.05, 0.1}) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
      CAPTURE(absorption_per_mm);
      CAPTURE(seed);
      std::mt19937 random(seed);
      oracle::ViewBench bench = coarse_bench();
      bench.absorption_per_mm = absorption_per_mm;
      const auto part = random_part(random);
      const auto found_at = [&](double x_mm, double y_mm) {
        bench.run_out_mm = {x_mm, y_mm};
        return found_in(bench, seen(bench, part, 0.01, seed, 90), {bench.axis_column, 0});
      };
      const RunOut none = found_at(0, 0);
      const RunOut some = found_at(0.16, -0.12);
      MESSAGE("without it ", none.size_mm(), " +- ", none.sigma_mm, " mm, with it ", some.mm[0], " ", some.mm[1],
              " +- ", some.sigma_mm, " mm");
      CHECK(!none.seen());
      CHECK(some.seen());
      CHECK(std::hypot(some.mm[0] - 0.16, some.mm[1] + 0.12) < 0.04);
    }
  }
}

TEST_CASE("specks in the window of a bath do not hide the run-out, nor are they one") {
  int seen_ones = 0;  // the bath leaves little to be seen: of one part it may be within what chance does
  for (unsigned seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    oracle::ViewBench bench = coarse_bench();
    bench.bath_index = 1.40;
    bench.window_mm = 20;
    std::mt19937 random(seed);
    const auto part = random_part(random);
    const auto found_at = [&](double x_mm) {
      bench.run_out_mm = {x_mm, 0};
      auto pixels = oracle::bench_views(bench, part, {}, 120);
      oracle::soil(bench, {.noise = 0.02, .specks = 10}, pixels);
      const std::vector<CameraView> views = views_of(bench, pixels);
      return found_in(bench, views, {bench.axis_column, 0});
    };
    const RunOut none = found_at(0);
    const RunOut some = found_at(0.2);
    MESSAGE("without it ", none.size_mm(), " +- ", none.sigma_mm, " mm, with it ", some.mm[0], " ", some.mm[1], " +- ",
            some.sigma_mm, " mm");
    CHECK(none.determined);
    CHECK(!none.seen());
    CHECK(some.determined);
    seen_ones += some.seen() ? 1 : 0;
    CHECK(std::hypot(some.mm[0] - 0.2, some.mm[1]) < 0.1);
  }
  CHECK(seen_ones >= 3);
}
