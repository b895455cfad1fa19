// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate beam: width by plane, from a bare sensor that is moved along the light, or from the side through resin.
#include "metrology/calibrate/beam.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text/image_size.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/image/view_source.hpp"
#include "metrology/calibrate/flat.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

constexpr int side_planes = 9;
constexpr double wanted_width_sigma_percent = 10;                // of the width at the axis
constexpr double divergence_of_half_angle = 1.7320508075688772;  // sqrt 3: of the chords of a round aperture

// What shines without the projector: a print, the room.
class Dark {
 public:
  explicit Dark(const std::string& path) : path_(path) {
    if (!path.empty()) image_ = io::read_field(path);
  }
  void take_off(Image& image) const {
    if (image_.values.empty()) return;
    if (image.width != image_.width || image.height != image_.height) {
      throw Error{Fault::data, path_ + ": has " + size_text(image_) + " pixels, the frames have " + size_text(image)};
    }
    for (std::size_t i = 0; i < image.size(); ++i) image.values[i] -= image_.values[i];
  }

 private:
  std::string path_;
  Image image_;
};

metrology::BeamWidths plane_by_plane(const ScanOptions& options, const model::Printer& printer) {
  const Dark dark(options.dark);
  metrology::BeamWidths widths;
  each_frame(options, printer, FrameKind::steady, [&](const ScanFrame& frame) {
    const double plane_mm = *options.first_mm + *options.step_mm * frame.shown;
    Image lit = frame.image;
    dark.take_off(lit);
    const auto px = metrology::line_width_px(lit, "plane at " + format_number(plane_mm) + " mm");
    widths.plane_mm.push_back(plane_mm);
    widths.fwhm_mm.push_back({px.value * options.pixel_mm, px.sigma * options.pixel_mm, px.n});
  });
  return widths;
}

metrology::BeamWidths from_the_side(const ScanOptions& options, const model::Printer& printer) {
  metrology::FrameMean frames;
  metrology::SideView view;
  each_frame(options, printer, FrameKind::steady, [&](const ScanFrame& frame) {
    frames.add(frame.image);
    view.pixel_mm = options.pixel_mm > 0 ? options.pixel_mm : frame.pixel_mm;
  });
  if (frames.count() == 0) throw Error{Fault::data, options.from + ": no frame shows the lit row"};
  Image mean = frames.mean();
  Dark(options.dark).take_off(mean);
  view.axis_column = printer.camera.axis_column.value_or(0.5 * (mean.width - 1));
  return metrology::side_widths(mean, view, printer, side_planes);
}

// What light in air has instead. Seen from the side the wall of a vial is as flat as a window: behind it light has
// smaller angles by the index there, and meets further away.
struct InAir {
  stats::Measured half_angle_deg;
  stats::Measured focus_mm;
};

InAir in_air(const metrology::MeasuredBeam& beam, const model::Printer* in_resin) {
  InAir air{beam.divergence_deg, beam.focus_mm};
  const double index = in_resin != nullptr ? in_resin->resin.index : 1;
  air.half_angle_deg.value *= index / divergence_of_half_angle;
  air.half_angle_deg.sigma *= index / divergence_of_half_angle;
  if (in_resin == nullptr) return air;
  const double radius_mm = in_resin->vial.radius_mm;
  const double window_mm = std::max(in_resin->bath.window_mm, radius_mm);
  air.focus_mm.value =
      (radius_mm + beam.focus_mm.value) / index + (window_mm - radius_mm) / in_resin->bath.index - window_mm;
  air.focus_mm.sigma /= index;
  return air;
}

}  // namespace

Finding scan_beam(const ScanOptions& options, const model::Printer& printer) {
  const auto widths = options.side ? from_the_side(options, printer) : plane_by_plane(options, printer);
  const auto found = metrology::measure_beam(widths);
  Finding finding;
  finding.value("waist", found.waist_mm, "mm", "fit over planes");
  finding.value("focus", found.focus_mm, "mm", "fit over planes");
  finding.value("axis_fwhm", found.axis_fwhm_mm, "mm", "fit over planes");
  finding.value("divergence", found.divergence_deg, "deg", "atan of width over distance");
  const InAir air = in_air(found, options.side ? &printer : nullptr);
  finding.value("half_angle", air.half_angle_deg, "deg", "divergence in air / sqrt 3: a round aperture");
  finding.value("focus_in_air", air.focus_mm, "mm", "behind the axis, without vial and bath");
  Json planes = Json::array();
  for (std::size_t i = 0; i < widths.plane_mm.size(); ++i) {
    planes.push_back(measured_json(widths.fwhm_mm[i], "mm", "full width at half maximum"));
    planes.back()["plane_mm"] = widths.plane_mm[i];
  }
  finding.facts["planes"] = planes;
  finding.facts["settings"] = {{"seen", options.side ? "from the side, in resin" : "on a bare sensor"}};
  finding.require_sigma("width at the axis", 100 * found.axis_fwhm_mm.sigma / found.axis_fwhm_mm.value,
                        wanted_width_sigma_percent, "%");
  return finding;
}

}  // namespace vam::calibrate_tool
