// SPDX-License-Identifier: GPL-3.0-or-later
// The light of a print, small enough to be drawn every second: what is on the screen, and the dose so far.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "io/settings/flip_log.hpp"
#include "light/simulation/simulation.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"

namespace vam::status_tool {

/// The sinogram of a print, thinned to at most some 300 columns and slices, and its middle slice as it is.
class LightView {
 public:
  /// Reads the stack once. Throws Fault::data for one that is no projector's.
  LightView(const std::string& sinogram, const model::Printer& printer);

  /// Fractions of the largest value over the width of the vial and the height of the stack: square pixels, the highest
  /// in row 0, columns in the direction of x.
  [[nodiscard]] Image projection(double angle_deg) const;
  /// The row of the middle slice, the same fractions, over the whole width of the stack.
  [[nodiscard]] std::vector<float> beam(double angle_deg) const;
  /// Dose of the middle slice, by level rays and without blur: x to the right, y up (row 0 is the largest y), over the
  /// square around the resin. In mJ/cm3 where the resin has a critical dose, else relative to the largest of a whole
  /// print.
  [[nodiscard]] Image dose(const std::vector<io::ShownImage>& shown) const;
  [[nodiscard]] bool absolute() const { return absolute_; }
  /// The largest dose that a turn gives.
  [[nodiscard]] double full_dose() const { return full_dose_; }

  /// Extent of the stack.
  [[nodiscard]] double half_width_mm() const { return 0.5 * info_.width * info_.pixel_mm; }
  [[nodiscard]] double low_mm() const { return info_.z_start_mm - 0.5 * info_.row_mm; }
  [[nodiscard]] double high_mm() const { return low_mm() + info_.count * info_.row_mm; }
  [[nodiscard]] double middle_mm() const { return info_.z_start_mm + middle_slice() * info_.row_mm; }
  [[nodiscard]] double resin_mm() const;

 private:
  [[nodiscard]] int middle_slice() const { return info_.count / 2; }
  [[nodiscard]] int row_of(double angle_deg) const;
  [[nodiscard]] Image expose(const std::vector<double>& turns) const;

  model::Printer printer_;
  model::StackInfo info_;
  int every_column_ = 1, every_slice_ = 1, every_row_ = 1;
  std::vector<Image> thinned_;  // one a slice kept, in ascending order
  Image middle_;
  float peak_ = 0;
  std::unique_ptr<light::Simulation> simulation_;  // of the middle slice
  double per_unit_ = 1;                            // dose of a radian of full light
  double full_dose_ = 0;
  bool absolute_ = false;
};

}  // namespace vam::status_tool
