// SPDX-License-Identifier: GPL-3.0-or-later
// vam-calibrate flat: frames of an even scene become the camera's flat field.
#include "metrology/calibrate/flat.hpp"

#include <cmath>

#include "io/exr/stack.hpp"
#include "io/image/image_file.hpp"
#include "io/image/view_source.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

metrology::FrameMean frames_of(const std::string& path) {
  metrology::FrameMean frames;
  io::ViewSource source(path, 1);
  for (io::CameraFrame frame; source.next(frame);) frames.add(frame.image);
  return frames;
}

}  // namespace

Finding scan_flat(const ScanOptions& options, const model::Printer& printer) {
  metrology::FrameMean frames;
  each_frame(options, printer, FrameKind::steady, [&](const ScanFrame& frame) { frames.add(frame.image); });
  metrology::FrameMean darkness;
  Image dark;
  double dark_sigma = 0;  // of one image it is not known
  if (!options.dark.empty()) {
    const bool image = io::is_image_file(options.dark);
    if (!image) darkness = frames_of(options.dark);
    dark = image ? io::read_field(options.dark) : darkness.mean();
    if (darkness.count() > 1) dark_sigma = darkness.noise() / std::sqrt(darkness.count());
  }
  const auto field = metrology::flat_field(frames, dark, dark_sigma);
  Finding finding;
  finding.value("level", field.level, "camera units", "mean of frames");
  finding.facts["flat"] = {{"unevenness", field.unevenness},
                           {"pixel_sigma", field.pixel_sigma},
                           {"frame_noise", frames.noise()},
                           {"dead_pixels", field.dead}};
  finding.products.push_back({"flat", ".exr", [image = field.field, &printer](const std::string& path) {
                                model::StackInfo info;
                                info.kind = model::Kind::frames;
                                info.space = model::Space::camera;
                                info.width = image.width;
                                info.height = image.height;
                                info.count = 1;
                                info.pixel_mm = info.row_mm = printer.camera.pixel_mm * printer.camera.binning;
                                info.units = "fraction of the mean";
                                io::StackWriter writer(path, info);
                                writer.write(image);
                                writer.commit();
                              }});
  return finding;
}

}  // namespace vam::calibrate_tool
