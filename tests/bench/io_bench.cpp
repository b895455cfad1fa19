// SPDX-License-Identifier: GPL-3.0-or-later
// Speed of files and pipes, in bytes of floats per second. A dense volume is noise: no tile, nothing for a compressor.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "io/exr/stack.hpp"
#include "io/vdb/vdb.hpp"

namespace {

using namespace vam;

std::string scratch_file(const char* extension) {
  return (std::filesystem::temp_directory_path() / ("vam-bench-" + std::to_string(getpid()) + extension)).string();
}

float noise(std::size_t i) { return static_cast<float>((i * 2654435761U) >> 8 & 0xffff) / 65536.0F + 0.001F; }

constexpr int side = 256;

std::vector<float> slab(int k) {
  std::vector<float> values(static_cast<std::size_t>(side) * side * 8);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = noise(i + values.size() * static_cast<std::size_t>(k));
  return values;
}

io::SparseVolume dense_volume() {
  io::SparseVolume volume("dose", model::centred_grid(side, side, side, 0.1));
  for (int k = 0; k < side; k += 8) volume.write_slices(k, 8, slab(k).data());
  return volume;
}

void set_rate(benchmark::State& state, std::size_t floats) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(floats * sizeof(float)));
}

void vdb_write_slices(benchmark::State& state) {
  const auto values = slab(0);
  for (auto _ : state) {
    io::SparseVolume volume("dose", model::centred_grid(side, side, side, 0.1));
    for (int k = 0; k < side; k += 8) volume.write_slices(k, 8, values.data());
  }
  set_rate(state, values.size() * side / 8);
}
BENCHMARK(vdb_write_slices)->UseRealTime()->Unit(benchmark::kMillisecond);

void vdb_read_slices(benchmark::State& state) {
  const auto volume = dense_volume();
  std::vector<float> values(volume.grid().slice_size() * 16);
  for (auto _ : state) {
    for (int k = 0; k < side; k += 16) volume.read_slices(k, 16, values.data());
  }
  set_rate(state, volume.grid().size());
}
BENCHMARK(vdb_read_slices)->UseRealTime()->Unit(benchmark::kMillisecond);

void vdb_write_file(benchmark::State& state) {
  auto volume = dense_volume();
  const std::string path = scratch_file(".vdb");
  for (auto _ : state) io::write_volume(path, volume);
  set_rate(state, volume.grid().size());
  std::filesystem::remove(path);
}
BENCHMARK(vdb_write_file)->UseRealTime()->Unit(benchmark::kMillisecond);

void vdb_read_file(benchmark::State& state) {
  auto volume = dense_volume();
  const std::string path = scratch_file(".vdb");
  io::write_volume(path, volume);
  for (auto _ : state) benchmark::DoNotOptimize(io::read_volumes(path));
  set_rate(state, volume.grid().size());
  std::filesystem::remove(path);
}
BENCHMARK(vdb_read_file)->UseRealTime()->Unit(benchmark::kMillisecond);

model::StackInfo stack_info() {
  model::StackInfo info;
  info.width = 512;
  info.height = 360;
  info.count = 64;
  info.pixel_mm = info.row_mm = 0.1;
  return info;
}

// Like a filtered sinogram: smooth, with empty margins.
Image sinogram_image(const model::StackInfo& info) {
  Image image(info.width, info.height);
  for (int y = 0; y < info.height; ++y) {
    for (int x = info.width / 4; x < info.width * 3 / 4; ++x) {
      image(x, y) = noise(static_cast<std::size_t>(y * info.width + x));
    }
  }
  return image;
}

void write_stack(const std::string& path, const char* compression) {
  const auto info = stack_info();
  const Image image = sinogram_image(info);
  io::StackWriter writer(path, info, {false, compression});
  for (int i = 0; i < info.count; ++i) writer.write(image);
  writer.commit();
}

constexpr const char* compressions[] = {"none", "rle", "zip", "piz"};

void exr_write(benchmark::State& state) {
  const char* compression = compressions[state.range(0)];
  state.SetLabel(compression);
  const std::string path = scratch_file(".exr");
  for (auto _ : state) write_stack(path, compression);
  set_rate(state, std::size_t{512} * 360 * 64);
  std::filesystem::remove(path);
}
BENCHMARK(exr_write)->DenseRange(0, 3)->UseRealTime()->Unit(benchmark::kMillisecond);

void exr_read(benchmark::State& state) {
  const char* compression = compressions[state.range(0)];
  state.SetLabel(compression);
  const std::string path = scratch_file(".exr");
  write_stack(path, compression);
  for (auto _ : state) {
    io::StackReader reader(path);
    Image image;
    model::ImageInfo about;
    while (reader.next(image, about)) benchmark::DoNotOptimize(image.values.data());
  }
  set_rate(state, std::size_t{512} * 360 * 64);
  std::filesystem::remove(path);
}
BENCHMARK(exr_read)->DenseRange(0, 3)->UseRealTime()->Unit(benchmark::kMillisecond);

void exr_to_dev_null(benchmark::State& state) {
  for (auto _ : state) write_stack("/dev/null", "none");
  set_rate(state, std::size_t{512} * 360 * 64);
}
BENCHMARK(exr_to_dev_null)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
