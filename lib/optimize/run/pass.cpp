// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/pass.hpp"

#include <algorithm>
#include <utility>

#include "base/compute/parallel.hpp"

namespace vam::optimize {

PassInput read_pass(const Pass& pass, const std::function<int(int job)>& slice, const SliceReader& reader,
                    light::Shape object, const Circle& circle, const Demands& demands, bool stacked) {
  check(demands);
  PassInput input;
  input.problem.demands = demands;
  input.problem.stacked = stacked;
  for (int first = pass.low; first < pass.high; first += lanes) {
    const int used = std::min(lanes, pass.high - first);
    SliceData all;
    for (int job = first; job < first + used; ++job) {
      const SliceData one = reader.read(slice(job));
      for (auto field :
           {&SliceData::target, &SliceData::insert, &SliceData::weight, &SliceData::tolerance, &SliceData::delivered}) {
        (all.*field).insert((all.*field).end(), (one.*field).begin(), (one.*field).end());
      }
    }
    const auto values = [](const std::vector<float>& v) { return v.empty() ? nullptr : v.data(); };
    append(input.problem, {values(all.target), values(all.weight), values(all.tolerance), values(all.delivered)}, used,
           object.width, object.height, circle);
    if (all.insert.empty()) continue;
    input.inserts.emplace_back(object.width, object.height);
    pack(all.insert.data(), used, input.inserts.back());
  }
  if (stacked) resolve_thin_slices(input.problem);
  return input;
}

std::vector<Slab> collapse_images(const Pass& pass, const std::function<Image(int job)>& image,
                                  const light::Operator& light) {
  std::vector<Slab> sinograms;
  Slab packed(light.image().width, light.image().height);
  for (int first = pass.low; first < pass.high; first += lanes) {
    const int used = std::min(lanes, pass.high - first);
    std::vector<float> images;
    for (int job = first; job < first + used; ++job) {
      const Image one = image(job);
      images.insert(images.end(), one.values.begin(), one.values.end());
    }
    pack(images.data(), used, packed);
    sinograms.emplace_back(light.sinogram().width, light.sinogram().height);
    light.collapse(packed, sinograms.back());
  }
  return sinograms;
}

std::vector<Image> expand_slab(const Pass& pass, std::size_t number, const Slab& sinogram,
                               const light::Operator& light) {
  const light::Shape shape = light.image();
  Slab packed(shape.width, shape.height);
  light.expand(sinogram, packed);
  const int first = pass.low + static_cast<int>(number) * lanes;
  const int from = std::max(pass.first - first, 0);  // lane
  const int count = std::max(std::min(pass.last - first, lanes) - from, 0);
  std::vector<Image> images(count, Image(shape.width, shape.height));
  parallel_for(shape.height, [&](int y) {
    const float* row = packed.at(0, y) + from;
    for (Image& image : images) {
      float* to = image.row(y);
      for (int x = 0; x < shape.width; ++x) to[x] = row[std::ptrdiff_t{x} * lanes];
      ++row;
    }
  });
  return images;
}

std::vector<Image> expand_images(const Pass& pass, std::span<const Slab> sinograms, const light::Operator& light) {
  std::vector<Image> images;
  for (std::size_t s = 0; s < sinograms.size(); ++s) {
    for (Image& image : expand_slab(pass, s, sinograms[s], light)) images.push_back(std::move(image));
  }
  return images;
}

}  // namespace vam::optimize
