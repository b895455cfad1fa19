// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-curethrough/slices.hpp"

#include <filesystem>
#include <memory>

#include "base/compute/parallel.hpp"
#include "base/error.hpp"
#include "io/exr/stack.hpp"
#include "io/image/image_file.hpp"

namespace vam::curethrough {

namespace {

SliceSource from_folder(const std::string& path, const resin::Response& response) {
  auto folder = std::make_shared<io::ImageFolder>(path);
  const GreyImage first = folder->read(0);
  std::vector<float> light;
  for (int v = 0; v <= first.full(); ++v) {
    light.push_back(static_cast<float>(response.intensity(static_cast<double>(v) / first.full())));
  }
  SliceSource slices{path, first.width, first.height, folder->count(), {}, {}, {}};
  slices.read = [folder, light, path](int n, Image& slice) {
    const GreyImage grey = folder->read(n);
    slice = Image(grey.width, grey.height);
    for (std::size_t p = 0; p < slice.size(); ++p) {
      if (grey.values[p] >= light.size()) {
        throw Error{Fault::data, folder->path(n) + ": has more grey levels than the first image"};
      }
      slice.values[p] = light[grey.values[p]];
    }
  };
  return slices;
}

SliceSource from_stack(const std::string& path, const resin::Response& response) {
  auto reader = std::make_shared<std::unique_ptr<io::StackReader>>(std::make_unique<io::StackReader>(path));
  const model::StackInfo info = (*reader)->info();
  io::require(path, info, model::Kind::frames, model::Space::projector);
  SliceSource slices{path, info.width, info.height, info.count, info.extra, info.history, {}};
  slices.read = [reader, path, response, grey = info.units == "grey"](int n, Image& slice) {
    if (n == 0) *reader = std::make_unique<io::StackReader>(path);
    model::ImageInfo about;
    if (!(*reader)->next(slice, about)) throw Error{Fault::bug, path + ": fewer slices than announced"};
    if (grey) resin::to_intensity(slice, response);
  };
  return slices;
}

}  // namespace

void to_grey(Image& slice, const resin::Response& response) {
  parallel_for(slice.height, [&](int y) {
    // Rows are long runs of few values, so the inverse is computed once a run.
    float* row = slice.row(y);
    float intensity = -1;
    float grey = 0;
    for (int x = 0; x < slice.width; ++x) {
      if (row[x] != intensity) {
        intensity = row[x];
        grey = static_cast<float>(response.grey(static_cast<double>(intensity)));
      }
      row[x] = grey;
    }
  });
}

SliceSource open_slices(const std::string& path, const resin::Response& response) {
  return std::filesystem::is_directory(path) ? from_folder(path, response) : from_stack(path, response);
}

}  // namespace vam::curethrough
