// SPDX-License-Identifier: GPL-3.0-or-later
// render_views SHAPE VIEWS.exr [key=value...]: what a camera sees of a shape that stands in glass and resin, as an EXR
// frame stack, by the oracle's ray tracer. The rig is glass_rig() of synthetic_views.hpp.
//   columns rows pixel (mm): of the camera    angles: a turn    turns    noise: deviation, in the views' units
//   offset (px) tilt (deg): of the axis       growth: share of the radius there at the first turn; all is at the last
//   step (mm): of the sums along the rays    lost: views that are missing in the middle of the second turn
//   clipped: 1 for a camera that reads 0 below 0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <string>

#include "io/exr/stack.hpp"
#include "lib/metrology/synthetic_views.hpp"

int main(int argc, char** argv) try {
  using namespace vam;
  std::map<std::string, double> set{{"columns", 160}, {"rows", 64},  {"pixel", 0.12}, {"angles", 90},
                                    {"turns", 1},     {"noise", 0},  {"offset", 0},   {"tilt", 0},
                                    {"growth", 1},    {"step", 0.1}, {"lost", 0},     {"clipped", 0}};
  for (int i = 3; i < argc; ++i) {
    const std::string item = argv[i];
    const auto equals = item.find('=');
    set.at(item.substr(0, equals)) = std::stod(item.substr(equals + 1));
  }
  const auto whole = [&](const char* key) { return static_cast<int>(set.at(key)); };
  const solid::Field field = solid::make_shape(argv[1]);
  const test::FineDensity density(field, 0.05);
  auto camera = test::camera_bench(test::glass_rig(), whole("columns"), whole("rows"), set["pixel"]);
  camera.axis_column += set["offset"];
  camera.tilt_rad = set["tilt"] * 3.14159265358979 / 180;
  std::vector<model::ImageInfo> about;
  std::vector<metrology::CameraView> views;
  for (int turn = 0; turn < whole("turns"); ++turn) {
    // A print gels from the axis outwards.
    const double part = set["turns"] > 1 ? set["growth"] + (1 - set["growth"]) * turn / (set["turns"] - 1) : 1.0;
    const auto grown = [&, part](double x, double y, double z) {
      return std::hypot(x, y) <= part * field.radius_mm + 1e-9 ? density(x, y, z) : 0.0;
    };
    auto seen = test::take_views(camera, grown, test::even_angles(whole("angles")), set["noise"], 1,
                                 {set["step"], field.radius_mm + 0.2});
    if (turn == 1) {
      const auto middle = seen.begin() + whole("angles") / 2;
      seen.erase(middle, middle + whole("lost"));
    }
    for (auto& view : seen) {
      model::ImageInfo info;
      info.has_angle = info.has_time = true;
      info.angle_deg = view.angle_deg + 360 * turn;
      info.time_s = static_cast<double>(about.size()) / 30;
      about.push_back(info);
      for (float& value : view.image.values) {
        if (set["clipped"] != 0) value = std::max(value, 0.0F);
      }
      views.push_back(std::move(view));
    }
  }
  model::StackInfo info;
  info.kind = model::Kind::frames;
  info.space = model::Space::camera;
  info.width = camera.columns;
  info.height = camera.rows;
  info.count = static_cast<int>(views.size());
  info.pixel_mm = info.row_mm = set["pixel"];
  io::StackWriter writer(argv[2], info, about, {.half = false, .compression = "none"});
  for (const auto& view : views) writer.write(view.image);
  writer.commit();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "render_views: %s\n", error.what());
  return 1;
}
