// SPDX-License-Identifier: GPL-3.0-or-later
// An embossed print seen by a profilometer, against the contours of its design [RAY21 fig 8].
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "base/text/json_fwd.hpp"
#include "solid/mesh/height_map.hpp"

namespace vam::metrology {

/// A height image lying level: base at 0.
struct Relief {
  Image heights_mm;  // gaps filled from their neighbours
  Image measured;    // 1 where there was a reading, 0 in a gap
  double pixel_mm = 0;
  double tilt_deg = 0;    // of the plane that was taken off
  double plateau_mm = 0;  // median of what stands above half of itself
};

/// The medians of what lies below and above Otsu's threshold. Nothing where they are less than four spreads of the base
/// apart: noise alone, cut in two, is 2.4 apart. Heights that are not a number are gaps.
struct Plateaus {
  double base_mm = 0;
  double top_mm = 0;
};
[[nodiscard]] std::optional<Plateaus> plateaus(std::vector<float> heights_mm);

/// Takes off the plane through the base: what lies below Otsu's threshold, found and fitted in turns, at last without
/// what departs by more than 2.5 robust standard deviations: sides, dents and crumbs. Heights that are
/// not a number are gaps. Throws Fault::data when fewer than a tenth of the pixels are readings or nothing stands out.
[[nodiscard]] Relief levelled(const Image& heights_mm, double pixel_mm);

/// Where the design lies in the image: p -> scale * rotation(turn) * p + shift, both in mm about their middles, x to
/// the right and y up.
struct Placing {
  double scale = 1;  // below 1: the print shrank
  double turn_deg = 0;
  double shift_x_mm = 0;
  double shift_y_mm = 0;
};

enum class EmbossAlign {
  none,     // middle on middle
  near,     // from there
  any_turn  // from every 15 degrees
};

struct Emboss {
  Placing placing;
  double outline_rms_mm = 0;   // distance of the design's outline to the print's, both at half height
  double outline_mean_mm = 0;  // signed, positive where the print reaches beyond the design
  double outline_max_mm = 0;
  double iou = 0;               // of the two areas above half height
  double height_mm = 0;         // median over the design's area, 0.15 mm and more from its outline
  double height_sigma_mm = 0;   // by the median absolute deviation
  double design_height_mm = 0;  // of the emboss above its base
  Image design;                 // the design's heights above its base, placed, on the image's pixels
};

/// Fits the design's outline at half height to the print's, with shrinkage: Gauss-Newton on the distance to the print's
/// outline. Throws Fault::data when the design is flat or does not meet the image.
[[nodiscard]] Emboss compare_emboss(const Relief& print, const solid::HeightMap& design, EmbossAlign align);

/// Heights along a straight line in the image, ends in pixels; one value each half pixel, of the print not a number
/// beside lost readings.
struct Section {
  std::vector<double> along_mm;
  std::vector<double> print_mm;
  std::vector<double> design_mm;
};
[[nodiscard]] Section section(const Relief& print, const Emboss& emboss, double x0, double y0, double x1, double y1);

[[nodiscard]] Json to_json(const Relief& print, const Emboss& emboss);

/// The names and values that --require knows.
[[nodiscard]] const std::vector<std::string>& emboss_names();
[[nodiscard]] double figure(const Emboss& emboss, const std::string& name);

}  // namespace vam::metrology
