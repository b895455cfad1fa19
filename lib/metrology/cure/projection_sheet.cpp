// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/cure/projection_sheet.hpp"

#include <algorithm>
#include <utility>

#include "base/compute/parallel.hpp"

namespace vam::metrology {

namespace {

Image padded(const Image& image, int width, int height) {
  Image out(width, height);
  const int x0 = (width - image.width) / 2;
  const int y0 = (height - image.height) / 2;
  for (int y = 0; y < image.height; ++y) std::copy_n(image.row(y), image.width, out.row(y + y0) + x0);
  return out;
}

void add_row(const SumProjections& sums, const std::string& what, std::vector<SheetView>& sheet) {
  const int width = std::max(sums.along_z.width, sums.along_x.width);
  const int height = std::max(sums.along_z.height, sums.along_x.height);
  float brightest = 0;
  for (const Image* image : {&sums.along_z, &sums.along_y, &sums.along_x}) {
    brightest = std::max(brightest, *std::max_element(image->values.begin(), image->values.end()));
  }
  for (const auto& [image, from] :
       {std::pair{&sums.along_z, "top"}, {&sums.along_y, "front"}, {&sums.along_x, "side"}}) {
    Image scaled = padded(*image, width, height);
    for (float& value : scaled.values) value = brightest > 0 ? value / brightest : 0.0F;
    sheet.push_back({std::move(scaled), what + " " + from});
  }
}

model::Volume sampled(const model::StretchedVolume& target, const model::Grid& g) {
  model::Volume out{g, std::vector<float>(g.size())};
  parallel_for(g.nz, [&](int k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) out.slice(k)[j * g.nx + i] = target.at(g.x_mm(i), g.y_mm(j), g.z_mm(k));
    }
  });
  return out;
}

}  // namespace

std::vector<SheetView> projection_sheet(const model::Volume& scatter, std::optional<double> level,
                                        const model::StretchedVolume* target) {
  std::vector<SheetView> sheet;
  add_row(sum_projections(scatter), "volume", sheet);
  if (level) add_row(sum_projections(scatter, level), "print", sheet);
  if (target != nullptr) add_row(sum_projections(sampled(*target, scatter.grid)), "design", sheet);
  return sheet;
}

}  // namespace vam::metrology
