// SPDX-License-Identifier: GPL-3.0-or-later
// From sinograms to the frames of a projector: slices by angles become one image per stage angle.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "base/pixels.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"

namespace vam::optics {

/// Frame n is centred on time n / fps, when the stage stands at n * step_deg; it is shown for one frame period around
/// it.
struct FrameSchedule {
  int count = 0;
  double fps = 0;
  double step_deg = 0;  // by which the stage turns from frame to frame

  [[nodiscard]] double time_s(int n) const { return n / fps; }
  [[nodiscard]] double angle_deg(int n) const { return n * step_deg; }
};

/// All frames of `turns` turns at fps and stage speed. Throws Fault::usage for fewer than 2 frames a turn or more than
/// ten million in all.
[[nodiscard]] FrameSchedule frame_schedule(double fps, double speed_deg_s, double turns);

/// Where frames put the part: device pixels, row 0 at the top, z upwards, before the orientation is applied.
struct FramePlace {
  int columns = 0;
  int rows = 0;
  double pixel_mm = 0;
  double axis_row = 0;       // of z = 0
  double column_offset = 0;  // moves the light to the right
};
[[nodiscard]] FramePlace frame_place(const model::Projector& projector, double column_offset, double row_offset);

/// How far slices of one or several whole rows lie beside the rows, in rows, up to 0.5; 0 of slices of another pitch.
[[nodiscard]] double beside_rows(const model::StackInfo& info, const FramePlace& place);

/// Takes a sinogram stack slice by slice and gives frames. Holds the lit part of every slice as floats: at most 4 bytes
/// x angles x slices x columns.
class FrameComposer {
 public:
  /// `subject` begins messages. Throws Fault::data unless the rows of the stack are one turn, or have poses, its width
  /// is the projector's columns and its pitch the projector's pixel.
  FrameComposer(std::string subject, const model::StackInfo& info, const FramePlace& place);

  /// The next slice, at z; columns are moved by the column offset (linear interpolation). Throws Fault::data for values
  /// that are negative.
  void add(const Image& sinogram, double z_mm);

  /// Throws Fault::data when light lies on rows or columns that the projector does not have, with both numbers, and
  /// when there is no light at all. What is less than half a level of 16 bits does not count as light.
  void check() const;

  /// Largest value of all slices, in the units of the stack.
  [[nodiscard]] float peak() const { return peak_; }

  /// What the projector must show around one stage angle, over the span that the stage turns meanwhile, in the units of
  /// the stack: interpolated between the sinogram's angles, or averaged over those that the span covers. A row shows
  /// the mean over its height, dark beyond the slices, so that each slice delivers all its light where it is. The stack
  /// is repeated turn by turn, but for poses that do not return to the first one: beyond the ends the last frame holds.
  /// The image is made in the memory of `reused`. Many threads may ask at once.
  [[nodiscard]] Image frame(double angle_deg, double span_deg, Image reused = {}) const;
  /// The same of a part of the frame only.
  [[nodiscard]] Image frame(double angle_deg, double span_deg, const PixelRect& part, Image reused) const;

  /// All pixels that are lit in some frame are in it, and at least one.
  [[nodiscard]] PixelRect lit() const;

 private:
  struct Slice {
    double z_mm = 0;
    int first = 0;  // device column of the first value of a row
    int width = 0;  // 0: dark
    float peak = 0;
    std::vector<float> values;  // angles x width
  };
  void check_columns(float dark) const;
  void check_rows(float dark) const;
  void add_row(const Slice& slice, int angle, float weight, const PixelRect& part, float* row) const;
  [[nodiscard]] double row_of(double z_mm) const { return place_.axis_row - z_mm / place_.pixel_mm; }

  [[nodiscard]] double slice_mm() const { return slices_.size() > 1 ? info_.row_mm : place_.pixel_mm; }

  std::string subject_;
  model::StackInfo info_;
  FramePlace place_;
  std::vector<Slice> slices_;
  std::vector<float> column_peak_;  // largest value on device column index - columns, three times as many columns
  float peak_ = 0;
  bool repeats_ = true;
};

/// Turns that a sinogram stack covers: 1 unless it has poses.
[[nodiscard]] double turns_of(const model::StackInfo& info);

/// Turns for which the stack is shown: `requested`, or else its own where it has poses, or else `usual`. Throws
/// Fault::usage for any other number than its own where the poses do not return to the first one.
[[nodiscard]] double turns_to_show(const model::StackInfo& info, std::optional<double> requested, double usual);

/// Flips columns (left-right), rows (up-down) or both, for a projector that is mounted that way: "normal",
/// "flip-columns", "flip-rows" or "rotate-180".
void orient(Image& image, const std::string& orientation);

/// Where a part of an image of columns x rows is thereafter.
[[nodiscard]] PixelRect oriented(const PixelRect& part, int columns, int rows, const std::string& orientation);

/// The stack that frames make: kind, space, size, pitches, angles, poses; row_mm is negative while row 0 is the
/// uppermost.
[[nodiscard]] model::StackInfo frames_info(const model::StackInfo& sinogram, const FramePlace& place,
                                           const FrameSchedule& schedule, const std::string& orientation);

}  // namespace vam::optics
