// SPDX-License-Identifier: GPL-3.0-or-later
// Flatland movie: projections of one slice smeared across the image, frame by frame, to validate computed axial
// lithography on a thin layer of resin in the image plane [CAL17 fig 3]. The layer adds the frames up.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"

namespace vam::optics {

/// The image plane: the part's x to the right, y up, the axis at (axis_column, axis_row) from the top left.
struct ImagePlane {
  int columns = 0;
  int rows = 0;
  double pixel_mm = 0;
  double axis_column = 0;
  double axis_row = 0;
};

/// The projector's image with the axis of the part in the middle, moved by the offsets in pixels to the right and
/// down.
[[nodiscard]] ImagePlane flatland_canvas(const model::Projector& projector, double column_offset, double row_offset);

/// Smears one 1-D parallel projection (pitch detector_mm, axis in the middle) across the plane along the light: pixel
/// (x, y) shows the projection at t = x cos theta + y sin theta [CAL17 eq 1], interpolated linearly, dark beyond its
/// ends.
[[nodiscard]] Image smear(std::span<const float> projection, double detector_mm, double angle_rad,
                          const ImagePlane& canvas);

/// The row of a virtual sinogram at one part angle, over the span that the stage turns meanwhile: interpolated between
/// its angles, or averaged over those that the span covers.
[[nodiscard]] std::vector<float> projection_at(const Image& sinogram, const model::StackInfo& info, double angle_deg,
                                               double span_deg);

/// The slice of a virtual sinogram stack that is nearest to one z, as a source of frames.
class FlatlandSlice {
 public:
  /// `subject` begins messages.
  FlatlandSlice(std::string subject, const model::StackInfo& info, const ImagePlane& canvas, double z_mm);

  /// The next slice of the stack; only the nearest so far is kept.
  void add(const Image& sinogram, double z_mm);

  /// Throws Fault::data when no slice lies at z (the range is in the message), or it is dark or has negative values.
  void check() const;

  [[nodiscard]] float peak() const;
  /// As FrameComposer::frame, but in memory of its own.
  [[nodiscard]] Image frame(double angle_deg, double span_deg, const Image& reused = {}) const;

 private:
  std::string subject_;
  model::StackInfo info_;
  ImagePlane canvas_;
  double wanted_mm_;
  double nearest_mm_ = 0;
  double low_mm_ = 0;  // of all slices
  double high_mm_ = 0;
  Image nearest_;
};

}  // namespace vam::optics
