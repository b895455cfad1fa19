#include "metrology/ost/private/camera_sinograms.hpp"

#include "base/index.hpp"
#include "base/parallel.hpp"

namespace vam::metrology {

std::vector<Image> camera_sinograms(std::span<const CameraView> views, const AngleGrid& turn, const AxisPose& axis,
                                    const LevelRows& rows, std::size_t heights) {
  std::vector<Image> level(views.size());
  parallel_for(count_of(views), [&](int i) {
    const auto v = static_cast<std::size_t>(i);
    level[v] = rows.of(views[v].image, axis);
  });
  const int columns = views.front().image.width;
  const int angles = turn.summary().angles;
  std::vector<Image> sinograms(heights);
  parallel_for(static_cast<int>(heights), [&](int k) {
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
