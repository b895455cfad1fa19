// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/text/json.hpp"
#include "sim/bench/scene.hpp"
#include "sim/bench/world.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::sim;

namespace {

SimBench small_bench() {
  SimBench bench;
  bench.columns = 301;  // 0.1 mm apart: column 150 is the axis
  bench.rows = 41;
  bench.printer.camera.pixel_mm = 0.1;
  bench.printer.camera.azimuth_deg = 0;
  bench.background = 0;
  return bench;
}

SimMoment at(auto&& world, double t_s) { return world.during(t_s, t_s + 1e-6).front(); }

// Brightness-weighted mean column of the middle row, from the axis; NaN when it is black.
double middle_px(const GreyImage& levels) {
  double sum = 0;
  double moment = 0;
  for (int c = 0; c < levels.width; ++c) {
    sum += levels(c, levels.height / 2);
    moment += levels(c, levels.height / 2) * (c - 0.5 * (levels.width - 1));
  }
  return moment / sum;
}

double total(const GreyImage& levels) {
  double sum = 0;
  for (const auto level : levels.values) sum += level;
  return sum;
}

}  // namespace

TEST_CASE("A ball on the axis looks as wide as refraction makes it, and grows with the light") {
  SimBench bench = small_bench();
  bench.bodies = parse_bodies("sphere:diameter=4");
  bench.lit_s = 8;
  const SimScene scene(bench, 1, 16);
  for (const double lit_s : {1.0, 8.0}) {
    const GreyImage levels = scene.render({0, nullptr, lit_s}, 20000, 0);
    const double radius_mm = 2 * std::cbrt(lit_s / 8);  // volume in proportion
    int seen = 0;
    for (int c = 0; c < levels.width; ++c) {
      // The chief ray of a column at x meets the ball when its offset x cos(phi) / n is less than the radius.
      const double x_mm = 0.1 * (c - 150);
      const double offset_mm = x_mm * std::cos(std::atan(x_mm / bench.printer.camera.distance_mm)) / 1.53;
      CHECK((levels(c, 20) > 0) == (std::abs(offset_mm) < radius_mm));
      seen += levels(c, 20) > 0 ? 1 : 0;
    }
    CHECK(seen > 20);
    CHECK(middle_px(levels) == doctest::Approx(0).epsilon(1e-9));
  }
  CHECK(total(scene.render({0, nullptr, 0}, 20000, 0)) == 0);
}

TEST_CASE("What turns with the stage is seen at x cos(theta + azimuth) + y sin(theta + azimuth)") {
  SimBench bench = small_bench();
  bench.bodies = parse_bodies("sphere:x=3,diameter=1");
  bench.lit_s = 1;
  const SimScene front(bench, 1, 16);
  CHECK(middle_px(front.render({0, nullptr, 1}, 20000, 0)) > 40);
  CHECK(middle_px(front.render({180, nullptr, 1}, 20000, 0)) < -40);
  bench.printer.camera.azimuth_deg = 90;
  const SimScene side(bench, 1, 16);
  CHECK(middle_px(side.render({270, nullptr, 1}, 20000, 0)) ==
        doctest::Approx(middle_px(front.render({0, nullptr, 1}, 20000, 0))));
  CHECK(middle_px(side.render({90, nullptr, 1}, 20000, 0)) < -40);
}

// The sign of the square is that of [physics §12].
TEST_CASE("A lit column glows while it crosses resin: up to R_e = R / sqrt(1 - (R/D)^2)") {
  SimBench bench = small_bench();
  bench.printer.camera.azimuth_deg = 90;
  bench.bodies.clear();
  const auto& projector = bench.printer.projector;
  const double distance_mm = *model::columns_lens_mm(projector);
  const double ratio = bench.printer.vial.radius_mm / distance_mm;
  const double edge_px = bench.printer.vial.radius_mm / std::sqrt(1 - ratio * ratio) / projector.pixel_mm;
  bench.centre_px = 5;
  const SimScene scene(bench, 1, 16);
  const auto glow = [&](double from_axis_px) {
    GreyImage image(projector.columns, projector.rows, 8);
    const auto column = static_cast<int>(std::floor(projector.axis_column + from_axis_px));
    for (int row = 0; row < image.height; ++row) image(column, row) = 255;
    return total(scene.render({0, &image, 0}, 20000, 0));
  };
  CHECK(glow(5 + edge_px + 3) == 0);
  CHECK(glow(5 - edge_px - 3) == 0);
  const double inside = glow(5);
  CHECK(inside > 0);
  CHECK(glow(5 + edge_px - 3) > 0.1 * inside);
  CHECK(glow(5 - edge_px + 3) > 0.1 * inside);
}

TEST_CASE("Noise is seeded by frame and has its spread; vignetting darkens the corners alone") {
  SimBench bench = small_bench();
  bench.bodies.clear();
  bench.background = 0.5;
  bench.noise = 0.01;
  const SimScene scene(bench, 1, 16);
  const GreyImage one = scene.render(SimMoment{}, 20000, 3);
  CHECK(one == scene.render(SimMoment{}, 20000, 3));
  CHECK(one != scene.render(SimMoment{}, 20000, 4));
  double sum = 0;
  double squares = 0;
  for (const auto level : one.values) {
    const double value = level / 65535.0;
    sum += value;
    squares += value * value;
  }
  const auto n = static_cast<double>(one.values.size());
  CHECK(sum / n == doctest::Approx(0.5).epsilon(0.001));                                     // 11 standard errors
  CHECK(std::sqrt(squares / n - sum * sum / n / n) == doctest::Approx(0.01).epsilon(0.03));  // 5 of them
}

TEST_CASE("The simulated bench follows stage and flip logs as they grow: true angle, shown image, seconds of light") {
  const std::string folder = std::filesystem::temp_directory_path() / ("vam-world-" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  const std::string angles = folder + "/angles";
  const std::string shown = folder + "/shown";
  SimSources sources{.angles = angles, .shown = shown};
  sources.images.resize(2, GreyImage(2, 2, 8));
  SimWorld world(sources, 100);
  CHECK(at(world, 100).angle_deg == 0);
  CHECK(at(world, 100).image == nullptr);
  std::ofstream table(angles);
  std::ofstream flips(shown);
  table << R"({"t_monotonic_s":100.0,"event":"angle","angle_deg":10,"speed_deg_s":20})"
        << "\n"
        << R"({"t_monotonic_s":100.1,"event":"angle","angle_deg":12,"spe)" << std::flush;  // half a line
  flips << R"({"t_monotonic_s":100.0,"event":"flip","frame":1})"
        << "\n"
        << R"({"t_monotonic_s":101.5,"event":"flip","frame":-1})"
        << "\n"
        << std::flush;
  CHECK(at(world, 100.05).angle_deg == doctest::Approx(11));
  table << R"(ed_deg_s":20})"
        << "\n"
        << R"({"t_monotonic_s":100.2,"event":"standing","angle_deg":14})"
        << "\n"
        << std::flush;
  CHECK(at(world, 100.15).angle_deg == doctest::Approx(13));
  CHECK(at(world, 105).angle_deg == doctest::Approx(14));
  CHECK(at(world, 101).lit_s == doctest::Approx(1));
  CHECK(at(world, 101).image != nullptr);
  CHECK(at(world, 102).lit_s == doctest::Approx(1.5));
  CHECK(at(world, 102).image == nullptr);
  // An exposure across the black flip at 101.5, while the stage stands.
  const auto exposure = world.during(101.4, 101.7);
  REQUIRE(exposure.size() == 2);
  CHECK(exposure[0].image != nullptr);
  CHECK(exposure[0].share == doctest::Approx(1.0 / 3));
  CHECK(exposure[1].image == nullptr);
  // And one while it turns by 2 degrees: four parts, their middles half a degree apart.
  const auto turning = world.during(100, 100.1);
  REQUIRE(turning.size() == 4);
  CHECK(turning[1].angle_deg - turning[0].angle_deg == doctest::Approx(0.5));
  std::filesystem::remove_all(folder);
}

TEST_CASE("The simulated bench shows the test pattern that the projector's log names") {
  const std::string shown = std::filesystem::temp_directory_path() / ("vam-world-shown-" + std::to_string(getpid()));
  SimSources sources{.shown = shown, .draw = [](const Json& event) {
                       return std::vector(1, GreyImage(event.value("width_px", 0), 1, 8));
                     }};
  SimWorld world(sources, 100);
  std::ofstream flips(shown);
  flips << R"({"t_monotonic_s":99.0,"event":"pattern","name":"row","width_px":7})"
        << "\n"
        << R"({"t_monotonic_s":100.0,"event":"flip","frame":0})"
        << "\n"
        << std::flush;
  REQUIRE(at(world, 100.5).image != nullptr);
  CHECK(at(world, 100.5).image->width == 7);
  flips << R"({"t_monotonic_s":101.0,"event":"pattern","name":"row","width_px":9})"
        << "\n"
        << std::flush;
  CHECK(at(world, 101.2).image->width == 7);  // until a flip shows it
  flips << R"({"t_monotonic_s":101.4,"event":"flip","frame":0})"
        << "\n"
        << std::flush;
  CHECK(at(world, 101.5).image->width == 9);
  CHECK(at(world, 101.2).image->width == 7);
  std::filesystem::remove(shown);
}

TEST_CASE("The simulated bench refuses frames of which it has no images, and follows them where it shows none") {
  const std::string shown = std::filesystem::temp_directory_path() / ("vam-world-frames-" + std::to_string(getpid()));
  std::ofstream(shown) << R"({"t_monotonic_s":100.0,"event":"flip","frame":0})"
                       << "\n"
                       << R"({"t_monotonic_s":101.0,"event":"frames","turn":2,"sinogram":"new.exr"})"
                       << "\n"
                       << R"({"t_monotonic_s":101.1,"event":"flip","frame":0})"
                       << "\n";
  SimSources sources{.shown = shown};
  CHECK(at(SimWorld(sources, 100), 102).lit_s == doctest::Approx(2));
  sources.images.resize(1, GreyImage(2, 2, 8));
  SimWorld world(sources, 100);
  CHECK_THROWS_WITH_AS(at(world, 102),
                       (shown + ": shows other frames since turn 2, which the simulated camera does not follow; print "
                                "without --frames-from")
                           .c_str(),
                       Error);
  std::filesystem::remove(shown);
}

TEST_CASE("The simulated bench follows a log by its name: the old file to its end, then the new one") {
  const std::string shown = std::filesystem::temp_directory_path() / ("vam-world-again-" + std::to_string(getpid()));
  SimSources sources{.shown = shown};
  sources.images.resize(2, GreyImage(2, 2, 8));
  SimWorld world(sources, 100);
  const auto flip = [](double t_s, int frame) {
    return R"({"t_monotonic_s":)" + std::to_string(t_s) + R"(,"event":"flip","frame":)" + std::to_string(frame) + "}\n";
  };
  std::ofstream flips(shown);
  flips << flip(100, 0) << std::flush;
  CHECK(at(world, 100.5).image != nullptr);
  flips << flip(101, -1) << R"({"t_monotonic_s":101.2,"ev)" << std::flush;  // as a program leaves it that is killed
  std::filesystem::remove(shown);
  CHECK(at(world, 101.5).image == nullptr);  // by the old file, as there is no other
  std::ofstream again(shown);
  again << flip(102, 1) << std::flush;
  CHECK(at(world, 101.9).image == nullptr);
  CHECK(at(world, 102.5).image != nullptr);
  CHECK(at(world, 102.5).lit_s == doctest::Approx(1.5));
  std::filesystem::remove(shown);
}

TEST_CASE("An exposure is the sum of its parts; a card's target brightness is the image mean, with the lens' shading") {
  SimBench bench = small_bench();
  bench.bodies.clear();
  bench.card = true;
  bench.glow = 0.8;
  bench.vignetting = 0.4;
  const SimScene scene(bench, 1, 16);
  GreyImage half(4, 4, 8);
  std::fill_n(half.values.begin(), 8, std::uint16_t{255});
  CHECK(scene.render({0, &half, 0}, 20000, 0)(150, 20) == doctest::Approx(0.4 * 65535).epsilon(1e-3));
  CHECK(scene.render({0, &half, 0}, 20000, 0)(0, 0) == doctest::Approx(0.24 * 65535).epsilon(0.01));
  CHECK(scene.render(SimMoment{}, 20000, 0)(150, 20) == 0);
  const std::vector<SimMoment> blink{{0, &half, 0, 0.25}, {0, nullptr, 0, 0.75}};
  CHECK(scene.render(blink, 20000, 0)(150, 20) == doctest::Approx(0.1 * 65535).epsilon(1e-3));
}
