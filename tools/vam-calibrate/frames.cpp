// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "io/image/view_source.hpp"
#include "io/settings/flip_log.hpp"
#include "io/stream/stream.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

constexpr float full_level = 0.998F;       // 254 of 255 is below, 4092 of 4095 shifted to 16 bits is not
constexpr double allowed_share = 1e-4;     // of pixels at full level: hot ones
constexpr std::ptrdiff_t allowed_few = 3;  // in a small image

constexpr double margin_s = 0.02;  // either side of an exposure: a vertical blank, and the light's own time

// The image that was on from begin to end; nothing when it changed meanwhile or was black.
int shown_between(const std::vector<DisplayHistory>& flips, double begin_s, double end_s) {
  const auto later = [](double t_s, const DisplayHistory& showing) { return t_s < showing.t_s; };
  const auto first = std::upper_bound(flips.begin(), flips.end(), begin_s, later);
  const auto last = std::upper_bound(flips.begin(), flips.end(), end_s, later);
  return first == flips.begin() || first != last ? -1 : (first - 1)->frame;
}

// What a pixel at full level would have shown is not known: a curve made of it is wrong, and its scatter is small.
void refuse_over_exposed(const ScanOptions& options, const Image& image, const std::string& name) {
  const auto over = std::count_if(image.values.begin(), image.values.end(), [](float v) { return v >= full_level; });
  const double share = static_cast<double>(over) / static_cast<double>(image.size());
  if (over <= allowed_few || share <= allowed_share) return;
  throw Error{Fault::data, options.command + ": " + name + ": " + format_number(100 * share, 3) +
                               " % of the pixels are over-exposed (limit " + format_number(100 * allowed_share) +
                               " %); capture with a shorter --exposure, less gain or a lower intensity"};
}

}  // namespace

std::vector<DisplayHistory> read_flips(const std::string& path) {
  io::FlipLog log(path);
  log.read();
  std::vector<DisplayHistory> flips;
  for (const io::LoggedFlip& flip : log.flips()) {
    if (flips.empty() || flips.back().frame != flip.frame) flips.push_back({flip.t_s, flip.frame});
  }
  if (flips.empty()) throw Error{Fault::data, path + ": contains no flips; give the log of vam-project"};
  return flips;
}

void each_frame(const ScanOptions& options, const model::Printer& printer, FrameKind wanted,
                const std::function<void(const ScanFrame&)>& take) {
  const std::vector<DisplayHistory> flips =
      options.flips.empty() ? std::vector<DisplayHistory>{} : read_flips(options.flips);
  const double half_s = 0.5e-6 * printer.camera.exposure_us;
  const double latency_s = 1e-3 * printer.projector.latency_ms;
  // Where angles are not needed, frames without are at none.
  const double step_deg =
      wanted == FrameKind::turned ? options.step_deg.value_or(0) : std::numeric_limits<double>::quiet_NaN();
  io::ViewSource source(options.from, step_deg);
  const double pixel_mm = source.pixel_mm() > 0 ? source.pixel_mm() : printer.camera.pixel_mm * printer.camera.binning;
  io::CameraFrame frame;
  for (int n = 0; source.next(frame); ++n) {
    refuse_over_exposed(options, frame.image, frame.name);
    ScanFrame scan{std::move(frame.image), frame.time_s, frame.time_sigma_s, frame.angle_deg, pixel_mm, n};
    if (!flips.empty()) {
      if (frame.time_s == 0) {
        throw Error{Fault::usage, frame.name + ": has no time, required by --flips; use frames of vam-capture"};
      }
      scan.shown = shown_between(flips, frame.time_s - latency_s - half_s - margin_s,
                                 frame.time_s - latency_s + half_s + margin_s);
      if (scan.shown < 0 && wanted != FrameKind::changing) continue;
    }
    take(scan);
  }
}

}  // namespace vam::calibrate_tool
