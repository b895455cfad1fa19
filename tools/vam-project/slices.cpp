// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/slices.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/image/any_frames.hpp"
#include "io/stream/stream.hpp"
#include "model/metadata.hpp"
#include "optics/slice_place.hpp"
#include "session/printer.hpp"
#include "vam-project/match.hpp"

namespace vam::project {

namespace {

std::optional<double> fact(const model::StackInfo& info, const char* name) {
  const auto value = model::stated_number(info.extra, name);
  return value && *value > 0 ? value : std::nullopt;
}

bool is_grey(const model::StackInfo& info) { return info.units == "grey" || info.units == "fraction of full grey"; }

void require_slices(const SliceStack& stack) {
  for (const model::ImageInfo& about : stack.about) {
    if (about.angle_deg == stack.about.front().angle_deg) continue;
    throw Error{Fault::data, stack.name +
                                 ": contains frames at stage angles; a sinogram, or the slices of "
                                 "vam-curethrough, is required"};
  }
}

double slices_per_s(const SliceStack& stack, const Options& options) {
  require_slices(stack);
  if (options.fps) return *options.fps;
  const auto slice_mm = fact(stack.info, "vam:slice_mm");
  const auto speed_mm_h = options.print_speed_mm_h ? options.print_speed_mm_h : fact(stack.info, "vam:speed_mm_h");
  if (slice_mm && speed_mm_h) return *speed_mm_h / 3600 / *slice_mm;
  if (options.print_speed_mm_h) {
    throw Error{Fault::usage, "--print-speed: " + stack.name + " does not state its slice height; give --fps"};
  }
  const auto& about = stack.about;
  if (about.size() > 1 && about.front().has_time && about.back().time_s > about.front().time_s) {
    return static_cast<double>(about.size() - 1) / (about.back().time_s - about.front().time_s);
  }
  throw Error{Fault::data, stack.name + ": states neither print speed and slice height nor times; give --fps"};
}

Frames frames_of(const SliceStack& stack, double fps, const Options& options, const model::Projector& projector) {
  const auto place = std::make_shared<optics::SlicePlace>(stack.name, projector, stack.info, options.column_offset,
                                                          options.row_offset);
  const auto response = std::make_shared<resin::Response>(session::response_of(projector));
  const auto dark = static_cast<float>(response->intensity(0));
  Frames frames{stack.info.count, fps, 0, {}, {}, true};
  frames.light = [=, grey = is_grey(stack.info), next = stack.next, name = stack.name](int, const Image&) {
    Image slice;
    if (!next(slice)) throw Error{Fault::bug, name + ": fewer slices than announced"};
    if (grey) resin::to_intensity(slice, *response);
    Image placed;
    if (&place->place(slice, dark, placed) == &slice) return slice;
    return placed;
  };
  return frames;
}

}  // namespace

SliceStack slices_of(const std::string& path, io::StackReader& reader) {
  io::require(path, reader.info(), model::Kind::frames, model::Space::projector);
  require_whole(path, reader.info());
  return {io::input_name(path), reader.info(), reader.about(), [&reader](Image& slice) {
            model::ImageInfo about;
            return reader.next(slice, about);
          }};
}

SliceStack slice_folder(const std::string& path) {
  const std::shared_ptr<io::ImageSource> source = io::open_images(path, io::FileType::images);
  SliceStack stack{path, source->info(), source->about(), [source](Image& slice) {
                     model::ImageInfo about;
                     return source->next(slice, about);
                   }};
  return stack;
}

bool is_folder(const std::string& path) {
  std::error_code ignored;
  return path != "-" && std::filesystem::is_directory(path, ignored);
}

Frames slices_in_time(const cli::App& app, const Options& options, const model::Printer& printer,
                      const SliceStack& slices) {
  app.require_for("slices", slices.name);
  return frames_of(slices, slices_per_s(slices, options), options, printer.projector);
}

Json slice_figures(const Frames& frames, const Options& options, const model::Projector& projector,
                   const resin::LightTally& tally) {
  Json report = figures(frames, projector.bits, options.full_scale.value_or(1), tally);
  report.erase("step_deg");
  return report;
}

model::StackInfo facts_of(const SliceStack& stack, double fps, const model::Projector& projector) {
  model::StackInfo info = stack.info;
  info.pixel_mm = info.row_mm = projector.pixel_mm;
  optics::SlicePlace(stack.name, projector, stack.info).apply(info);
  info.units = "fraction of full intensity";
  info.extra["vam:fps"] = format_number(fps, 9);
  if (const auto slice_mm = fact(info, "vam:slice_mm")) {
    info.extra["vam:speed_mm_h"] = format_number(fps * 3600 * *slice_mm, 9);
  }
  return info;
}

}  // namespace vam::project
