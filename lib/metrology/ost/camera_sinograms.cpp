#include "metrology/ost/private/camera_sinograms.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/cubic.hpp"
#include "base/index.hpp"
#include "base/parallel.hpp"

namespace vam::metrology {

std::vector<Image> level_views(std::span<const CameraView> views, const AxisPose& axis, const LevelRows& rows) {
  std::vector<Image> level(views.size());
  parallel_for(count_of(views), [&](int i) { level[i] = rows.of(views[i].image, axis); });
  return level;
}

void make_steady(std::vector<Image>& level, double background, std::span<const double> intensity) {
  if (background == 0 && intensity.empty()) return;
  const auto ground = static_cast<float>(background);
  parallel_for(count_of(level), [&](int i) {
    const float factor = intensity.empty() ? 1.0F : static_cast<float>(1 / intensity[i]);
    for (float& v : level[i].values) v = (v - ground) * factor;
  });
}

void undo_motion(std::vector<Image>& level, std::span<const ColumnMotion> motion, double axis_column) {
  struct ColumnTaps {
    int first;
    std::array<float, 4> weights;
  };
  parallel_for(count_of(level), [&](int i) {
    if (motion[i].shift_px == 0 && motion[i].stretch == 0) return;
    Image& image = level[i];
    std::vector<ColumnTaps> taps(image.width);
    for (int x = 0; x < image.width; ++x) {
      const double from = x + motion[i].at(x - axis_column);
      taps[x] = {floor_int(from) - 1, cubic_weights(static_cast<float>(from - std::floor(from)))};
    }
    std::vector<float> from(image.width);
    for (int k = 0; k < image.height; ++k) {
      float* to = image.row(k);
      std::copy(to, to + image.width, from.begin());
      for (int x = 0; x < image.width; ++x) {
        float sum = 0;
        for (int j = 0; j < 4; ++j) {
          sum += taps[x].weights[j] * from[std::clamp(taps[x].first + j, 0, image.width - 1)];
        }
        to[x] = sum;
      }
    }
  });
}

std::vector<Image> camera_sinograms(std::span<const Image> level, const AngleGrid& turn) {
  const int columns = level.front().width;
  const int angles = turn.summary().angles;
  std::vector<Image> sinograms(level.front().height);
  parallel_for(count_of(sinograms), [&](int k) {
    Image& sinogram = sinograms[k];
    sinogram = Image(columns, angles);
    for (int a = 0; a < angles; ++a) {
      float* out = sinogram.row(a);
      for (const auto& tap : turn.taps(a)) {
        const float* in = level[tap.frame].row(k);
        for (int x = 0; x < columns; ++x) out[x] += tap.weight * in[x];
      }
    }
  });
  return sinograms;
}

}  // namespace vam::metrology
