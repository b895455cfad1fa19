// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/turn.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "base/text/text.hpp"
#include "io/stream/stream.hpp"
#include "optics/flatland_movie.hpp"
#include "vam-project/match.hpp"

namespace vam::project {

namespace {

template <class Source>
void read_into(Source& source, io::StackReader& reader) {
  Progress progress("reading", reader.info().count);
  Image slice;
  for (model::ImageInfo about; reader.next(slice, about); progress.tick()) source.add(slice, about.z_mm);
  source.check();
}

void warn_of_pitch(const model::StackInfo& info, double pixel_mm, const std::string& name) {
  constexpr double same = 1e-3;
  const double rows = info.row_mm / pixel_mm;
  const double whole = std::max(std::round(rows), 1.0);
  if (info.count < 2 || !info.poses.empty() || std::abs(rows - whole) < same) return;
  warn(name + ": its slices are " + format_number(rows, 3) +
       " rows of the projector high, not a whole number, so that rows show means of neighbouring slices and the print "
       "is less sharp than vam-dose says; vam-slice --voxel " +
       format_number(whole * pixel_mm) + " makes whole rows");
}

void warn_beside_rows(double rows, const std::string& name) {
  constexpr double seen = 0.01;
  if (rows < seen) return;
  warn(
      name + ": its slices begin " + format_number(rows, 2) +
      " rows beside the projector's, so that rows on their borders show the mean of two; vam-slice with the settings " +
      "of this printer makes slices that begin with rows");
}

}  // namespace

Light read_light(const Options& options, io::StackReader& reader, const model::Projector& projector) {
  const auto& info = reader.info();
  require_whole(options.input, info);
  const double right = options.column_offset;
  const double down = options.row_offset;
  const PixelRect whole{0, 0, projector.columns, projector.rows};
  if (options.flatland_mm) {
    io::require(options.input, info, model::Kind::sinogram, model::Space::virtual_);
    const auto canvas = optics::flatland_canvas(projector, right, down);
    const auto slice = std::make_shared<optics::FlatlandSlice>(options.input, info, canvas, *options.flatland_mm);
    read_into(*slice, reader);
    return {[slice](double angle, double span, const PixelRect&, const Image&) { return slice->frame(angle, span); },
            static_cast<double>(slice->peak()), whole, whole};
  }
  io::require(options.input, info, model::Kind::sinogram, model::Space::projector);
  const auto place = optics::frame_place(projector, right, down);
  const auto composer = std::make_shared<optics::FrameComposer>(options.input, info, place);
  read_into(*composer, reader);
  warn_of_pitch(info, projector.pixel_mm, options.input);
  if (down == 0) warn_beside_rows(optics::beside_rows(info, place), options.input);
  return {[composer](double angle, double span, const PixelRect& part, Image reused) {
            return composer->frame(angle, span, part, std::move(reused));
          },
          static_cast<double>(composer->peak()), composer->lit(), whole};
}

session::Exposure exposure_of(const Options& options, const model::StackInfo& info, const Light& light,
                              const model::Printer& printer) {
  const session::GivenExposure given{options.turns, options.full_scale, options.multiplier, options.printer.sets};
  const std::string name = io::input_name(options.input);
  const auto exposure = session::exposure_of(name, info, printer, light.peak, given);
  const bool whole = options.live.from_deg == 0 && options.live.frames_from.empty();  // neither a rest nor renewed
  if (whole) session::require_dose(exposure, options.accept_dose, name);
  return exposure;
}

Dithering dithering_of(const Options& options, double frames_per_turn, double turns) {
  if (!options.dither_turns) return {};
  const int n = *options.dither_turns;
  const std::string what = "--dither " + std::to_string(n) + ": ";
  if (n > 1 && std::abs(frames_per_turn - std::round(frames_per_turn)) > 1e-6) {
    throw Error{Fault::usage, what + "a turn has " + format_number(frames_per_turn) +
                                  " frames, not a whole number; use --dither 1, or another --fps or --speed"};
  }
  if (n > 1 && std::abs(std::remainder(turns, n)) > 1e-6) {
    throw Error{Fault::usage, what + "does not divide the " + format_number(turns) + " turns; change one of them"};
  }
  return {n, round_int(frames_per_turn)};
}

Frames frames_of(const Light& light, const optics::FrameSchedule& schedule, const Dithering& dithering) {
  const PixelRect part = dithering.turns > 0 ? light.whole : light.lit;
  return {schedule.count,
          schedule.fps,
          schedule.step_deg,
          [&light, &schedule, part](int n, Image reused) {
            return light.frame(schedule.angle_deg(n), schedule.step_deg, part, std::move(reused));
          },
          part,
          false};
}

}  // namespace vam::project
