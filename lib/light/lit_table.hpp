// Which column lights a point of the lab, and how strongly: a table over polar coordinates, made from the ray map
// alone. The geometry does not depend on the stage angle, so one table serves every voxel at every angle.
#pragma once

#include <cstddef>
#include <vector>

#include "optics/vial.hpp"

namespace vam::light {

/// Points at lab polar coordinates (r, alpha) of the rays { t (cos d, sin d) + u (-sin d, cos d) }, t = x_v, d = delta:
/// t = r cos b, u = r sin b, alpha = b + delta(t). The irradiance there is T / |dt/dx_p - u d delta/dx_p| =
/// T / J |db/d alpha|: adjacent chief rays converge, so the light per width changes along the ray (J alone holds on
/// the axis only). Absorption multiplies it by e^{-mu s}, s = sqrt(R^2 - t^2) + u.
///
/// Within the reach every point has one ray from each side, solved by Newton. Beyond, the rays of one stage angle fold
/// (caustics): a point has up to four rays, or none; these rows are filled ray by ray, which keeps the light.
class LitTable {
 public:
  /// Rows are r_mm = (row + 0.5) * pitch; sheets are the branches of the map.
  struct Zone {
    double first_mm = 0;  // radius of row 0
    double pitch_mm = 0;
    int rows = 0;
    int sheets = 1;
    std::vector<float> x_p_mm;
    std::vector<float> strength;  // T / |...| e^{-mu s}; 0 = no ray
  };

  /// angles: stage angles of one turn; sense: +1 when alpha grows with the index. Radii up to r_max_mm are needed.
  LitTable(const optics::View& view, int angles, int sense, double absorption_per_mm, double r_max_mm, double pitch_mm);

  /// alpha = sense * (i * phases + phase) * 2 pi / (angles * phases) is at element i of series(zone, row, sheet,
  /// phase). The turn is stored twice, so that any `angles` consecutive elements can be read.
  [[nodiscard]] std::size_t series(const Zone& zone, int row, int sheet, int phase) const {
    return static_cast<std::size_t>((row * zone.sheets + sheet) * phases + phase) * static_cast<std::size_t>(length);
  }

  int angles = 0;
  int phases = 0;
  int length = 0;  // of a series: 2 * angles + 1
  double reach_mm = 0;
  double edge_mm = 0;  // radius of the resin
  Zone inner;          // to be interpolated between rows
  Zone outer;          // nearest row

 private:
  struct Light;
  void fill_inner_row(const Light& light, int row);
  void fill_outer_row(const Light& light, int row);
  void store(Zone& zone, int row, int sheet, int index, double x_p_mm, double strength);
  int sense_ = 1;
};

}  // namespace vam::light
