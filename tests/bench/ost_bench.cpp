// SPDX-License-Identifier: GPL-3.0-or-later
// One volume from 180 views of 480 x 300 pixels, by the stages of vam-ost, from PNG to VDB: the limit of them all is
// 1.0 s on two cores, and 30 frames a second live.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "io/image/image_file.hpp"
#include "io/image/view_source.hpp"
#include "io/vdb/vdb.hpp"
#include "metrology/ost/axis.hpp"
#include "metrology/ost/ost.hpp"
#include "metrology/ost/run_out.hpp"
#include "metrology/ost/views.hpp"

namespace {

using namespace vam;

constexpr int count = 180;
constexpr int columns = 480;
constexpr int rows = 300;

std::string scratch(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("vam-bench-" + std::to_string(getpid()) + name)).string();
}

// A rod that circles the axis, with noise, so that nothing is easy to compress.
GreyImage seen(int a) {
  GreyImage image(columns, rows, 16);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const double across = x - 239.5 - 40 * std::cos(2 * 3.14159265 * a / count);
      const auto noise = static_cast<double>((image.index(x, y) * 2654435761U + a * 40503U) >> 8 & 0x3ff);
      image(x, y) = static_cast<std::uint16_t>(1000 + noise +
                                               (y > 20 && y < 280 ? 50000 : 0) * std::exp(-across * across / 2000));
    }
  }
  return image;
}

class Folder {
 public:
  Folder() : path(scratch("-views")) {
    std::filesystem::create_directory(path);
    for (int a = 0; a < count; ++a) {
      std::ofstream(path + "/" + std::to_string(a) + ".png", std::ios::binary) << io::encode_png(seen(a));
    }
  }
  ~Folder() { std::filesystem::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::string path;
};

std::vector<metrology::CameraView> read(const std::string& folder) {
  io::ViewSource source(folder, 360.0 / count);
  std::vector<metrology::CameraView> views;
  for (io::CameraFrame frame; source.next(frame);) {
    if (!metrology::exposure_of(frame.image).problem().empty()) continue;
    views.push_back({metrology::corrected(std::move(frame.image), {}, 1, frame.name), frame.angle_deg, 0});
  }
  return views;
}

const std::vector<metrology::CameraView>& views() {
  static const auto all = read(Folder().path);
  return all;
}

metrology::OstReconstructor rig(double tilt_rad) {
  return {model::Printer{}, 0.05, columns, rows, {239.5, tilt_rad}, {}};
}

void read_views(benchmark::State& state) {
  const Folder folder;
  for (auto _ : state) benchmark::DoNotOptimize(read(folder.path).data());
}
BENCHMARK(read_views)->Unit(benchmark::kMillisecond)->UseRealTime();

void find_axis(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(metrology::find_axis(views()));
}
BENCHMARK(find_axis)->Unit(benchmark::kMillisecond)->UseRealTime();

void find_run_out(benchmark::State& state) {
  const auto reconstructor = rig(0);
  for (auto _ : state) benchmark::DoNotOptimize(reconstructor.find_run_out(views()));
}
BENCHMARK(find_run_out)->Unit(benchmark::kMillisecond)->UseRealTime();

void reconstruct(benchmark::State& state) {
  const auto reconstructor = rig(state.range(0) != 0 ? 0.005 : 0.0);
  for (auto _ : state) benchmark::DoNotOptimize(reconstructor.reconstruct(views()).values.data());
  state.counters["voxels"] = static_cast<double>(reconstructor.grid().size());
  state.counters["views/s"] = benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(reconstruct)->ArgName("tilted")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

void write_volume(benchmark::State& state) {
  const model::Volume volume = rig(0).reconstruct(views());
  const std::string path = scratch(".vdb");
  for (auto _ : state) {
    io::SparseVolume made("scatter", volume.grid);
    made.show(volume.values.data());
    io::write_volume(path, made);
  }
  std::filesystem::remove(path);
}
BENCHMARK(write_volume)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
