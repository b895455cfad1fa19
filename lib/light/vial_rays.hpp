// Which columns of the projector light a voxel of the turning vial, and how strongly.
#pragma once

#include <vector>

#include "light/lit_table.hpp"
#include "light/vial_kernel.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"
#include "optics/resample.hpp"

namespace vam::light {

/// Who lights what. Row a of a sinogram is at stage angle turn.start + a * turn.step; the part stands at direction *
/// stage angle + offset.
struct VialSetup {
  optics::View view;
  optics::Detector projector;
  optics::Turn turn;
  int direction = 1;
  double angle_offset_rad = 0;
  double absorption_per_mm = 0;
  model::Grid grid;      // only x and y matter
  double radius_mm = 0;  // voxels farther from the axis get no light
};

/// The printer's projector and vial, `angles` rows from stage angle 0. The radius is at most radius_mm and what the
/// projector's columns reach on either side.
[[nodiscard]] VialSetup vial_setup(const model::Printer& printer, const model::Grid& grid, int angles,
                                   double radius_mm);

/// Light of a column is linear between column centres and leaves dose T / |dx_v/dx_p - u d delta/dx_p| e^{-mu s} at the
/// voxel on its ray [RAY21 eq 8, with the convergence of neighbouring rays; physics section 2]. The mean over the voxel
/// is taken to second order, by a box of the variance of the voxel's shadow.
class VialRays {
 public:
  /// Throws Fault::data unless the rows are one turn, or when no column of the projector lights the resin.
  explicit VialRays(const VialSetup& setup);

  [[nodiscard]] const VialSetup& setup() const { return setup_; }
  /// The columns that light voxels: columns() from first_column() of the projector on.
  [[nodiscard]] int first_column() const { return first_; }
  [[nodiscard]] int columns() const { return static_cast<int>(shadows_.size()); }
  /// T e^{-mu sqrt(R^2 - t^2)} of a column: what gets to the plane of the axis.
  [[nodiscard]] double transmitted(int column) const { return transmitted_[static_cast<std::size_t>(column)]; }

  /// A row of light for voxels: column c is the weighted sum of columns first...first + weights.size() - 1, then dark
  /// ones to row_stride().
  struct Shadow {
    int first;
    std::vector<float> weights;
  };
  [[nodiscard]] const Shadow& shadow(int column) const { return shadows_[static_cast<std::size_t>(column)]; }
  static constexpr int padding = 2;  // dark columns on either side of a row of light
  [[nodiscard]] int row_stride() const { return columns() + 2 * padding; }

  /// A voxel as the table knows it; false where no light goes.
  struct Voxel {
    VialSource source;  // of row 0
  };
  [[nodiscard]] bool find(int i, int j, Voxel& voxel) const;
  /// Where it takes light from at rows [row, row + rows), in a buffer that begins at `row`; rows <= vial_rows.
  void taps(const Voxel& voxel, int row, int rows, VialTaps& taps) const;

 private:
  [[nodiscard]] int sense() const { return (setup_.turn.step_rad < 0 ? 1 : -1) * setup_.direction; }
  VialSetup setup_;
  light::LitTable table_;
  int first_ = 0;
  std::vector<Shadow> shadows_;
  std::vector<double> transmitted_;
  decltype(&baseline::vial_taps) make_taps_;
};

}  // namespace vam::light
