#include "oracle/skew_dose.hpp"

#include <cmath>
#include <numbers>

namespace vam::oracle {

SkewResult skew_dose(const SkewDose& setup, const std::function<double(int, int, int)>& intensity) {
  SkewResult result;
  result.dose.assign(static_cast<std::size_t>(setup.size) * setup.size * static_cast<std::size_t>(setup.slices), 0.0);
  const double turn = 2 * std::numbers::pi / setup.angles;
  const double step = 0.2 * setup.voxel;
  const double ray_area = setup.pixel * setup.pixel / (setup.rays * setup.rays);
  const double volume = setup.voxel * setup.voxel * setup.height;
  const double half = 0.5 * setup.size * setup.voxel;
  for (int r = 0; r < setup.rows; ++r) {
    for (int c = 0; c < setup.columns; ++c) {
      for (int k = 0; k < setup.rays * setup.rays; ++k) {
        const double x = (c - 0.5 * (setup.columns - 1) + (k % setup.rays + 0.5) / setup.rays - 0.5) * setup.pixel;
        const double z = setup.first_row + (r + (k / setup.rays + 0.5) / setup.rays - 0.5) * setup.pixel;
        const auto ray = trace(setup.bench, x, z);
        if (!ray) continue;
        double p[3], d[3];
        for (std::size_t i = 0; i < 3; ++i) {
          p[i] = static_cast<double>(ray->point[i]);
          d[i] = static_cast<double>(ray->direction[i]);
        }
        const double level = d[0] * d[0] + d[1] * d[1];
        const double way = -2 * (p[0] * d[0] + p[1] * d[1]) / level;  // to the other side of the resin
        // Steps within the box around the voxels only.
        const double middle = 0.5 * way;
        const double reach = std::min(middle, std::hypot(half, half) / std::sqrt(level));
        for (int a = 0; a < setup.angles; ++a) {
          const double light = intensity(c, r, a) * static_cast<double>(ray->transmittance) * ray_area;
          if (light == 0) continue;
          result.entered += light;
          result.absorbed += light * (1 - std::exp(-setup.absorption * way));
          const double cosine = std::cos(a * turn);
          const double sine = std::sin(a * turn);
          for (double s = middle - reach + 0.5 * step; s < middle + reach; s += step) {
            const double lab_x = p[0] + s * d[0];
            const double lab_y = p[1] + s * d[1];
            // The part stands turned by the stage angle.
            const double part_x = lab_x * cosine - lab_y * sine;
            const double part_y = lab_x * sine + lab_y * cosine;
            const int i = static_cast<int>(std::floor(part_x / setup.voxel + 0.5 * setup.size));
            const int j = static_cast<int>(std::floor(part_y / setup.voxel + 0.5 * setup.size));
            const int slice = static_cast<int>(std::floor((p[2] + s * d[2] - setup.first_slice) / setup.height + 0.5));
            if (i < 0 || j < 0 || slice < 0 || i >= setup.size || j >= setup.size || slice >= setup.slices) continue;
            const auto at = (static_cast<std::size_t>(slice) * setup.size + static_cast<std::size_t>(j)) *
                                static_cast<std::size_t>(setup.size) +
                            static_cast<std::size_t>(i);
            result.dose[at] +=
                light * step * (setup.absorption > 0 ? std::exp(-setup.absorption * s) : 1.0) * turn / volume;
          }
        }
      }
    }
  }
  return result;
}

}  // namespace vam::oracle
