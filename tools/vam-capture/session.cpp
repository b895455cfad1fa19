// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-capture/session.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/open/open.hpp"
#include "device/os/event_log.hpp"
#include "device/os/interrupt.hpp"
#include "device/port/lines.hpp"
#include "io/image/image_file.hpp"
#include "io/settings/sealed_text.hpp"
#include "session/printer.hpp"
#include "vam-capture/recording.hpp"
#include "vam-capture/sinks.hpp"

namespace vam::capture_tool {

namespace {

Json facts(device::Camera& camera) {
  const device::CameraMode mode = camera.mode();
  Json facts{{"camera", camera.identify()}, {"columns", mode.columns}, {"rows", mode.rows},
             {"bits", mode.bits},           {"fps", mode.fps},         {"exposure_us", mode.exposure_us},
             {"binning", mode.binning}};
  if (mode.gain) facts["gain"] = *mode.gain;
  if (mode.gamma) facts["gamma"] = *mode.gamma;
  if (mode.black_level) facts["black_level"] = *mode.black_level;
  if (!mode.automatic_off.empty()) facts["automatic_off"] = mode.automatic_off;
  return facts;
}

constexpr const char* simulated_frames = "frames of a simulated camera";  // in the history of a stack

bool is_folder(const std::string& path) { return path != "-" && !std::filesystem::path(path).has_extension(); }

device::CapturePlan plan_of(const Options& o, const model::Printer& printer) {
  device::CapturePlan plan;
  plan.triggered = o.camera.trigger == "software";
  plan.every_deg = o.every_deg;
  plan.by_number = is_folder(o.output);
  plan.latency_s = 1e-3 * o.lag_ms.value_or(printer.camera.lag_ms);
  if (o.max_lost) plan.max_lost = *o.max_lost;
  plan.frames = o.frames.value_or(0);
  if (!o.every_deg) return plan;
  const double places = 360 * o.turns.value_or(1) / *o.every_deg;
  if (!o.frames) plan.frames = std::lround(places);
  if (plan.frames < 1) throw Error{Fault::usage, "--view-step: exceeds --turns; give a smaller angle"};
  return plan;
}

model::StackInfo stack_info(const cli::App& app, const Options& o, const model::Printer& printer,
                            const device::CameraMode& mode, long count, bool simulated) {
  model::StackInfo info;
  info.kind = model::Kind::frames;
  info.space = model::Space::camera;
  info.width = mode.columns;
  info.height = mode.rows;
  info.count = static_cast<int>(count);
  info.pixel_mm = o.pixel_mm.value_or(printer.camera.pixel_mm * mode.binning);
  info.row_mm = -info.pixel_mm;
  info.z_start_mm = 0.5 * (mode.rows - 1) * info.pixel_mm;
  info.angle_step_deg = o.every_deg.value_or(0);
  info.units = "fraction of full scale";
  info.history.push_back(app.history());
  if (simulated) info.history.emplace_back(simulated_frames);
  return info;
}

std::unique_ptr<FrameStore> open_store(const cli::App& app, const Options& o, const model::Printer& printer,
                                       device::Camera& camera, long count) {
  if (is_folder(o.output)) {
    Json head{{"schema", FormatKind("vam-capture").schema()}};
    head.update(facts(camera));
    head["pixel_mm"] = o.pixel_mm.value_or(printer.camera.pixel_mm * camera.mode().binning);
    head["every_deg"] = o.every_deg.value_or(0);
    head["lag_ms"] = o.lag_ms.value_or(printer.camera.lag_ms);
    head["speed_deg_s"] = o.speed_deg_s ? Json(*o.speed_deg_s) : Json();  // null: not the source of the angles
    return open_folder(o.output, head);
  }
  const bool simulated = camera.identify().contains("simulated");
  const model::StackInfo info = stack_info(app, o, printer, camera.mode(), count, simulated);
  return o.live ? open_stream(o.output, info, o.stack) : open_stack(o.output, info, o.stack);
}

// Frames of a free-running camera are not where the views are wanted, but at multiples of their own.
void require_near_views(const Options& o, const device::CameraMode& mode) {
  constexpr double most_deg = 15;  // that vam-ost allows between views
  const bool runs_freely = o.camera.trigger.empty() || o.camera.trigger == "free";
  if (!o.every_deg || !o.speed_deg_s || !runs_freely || *o.every_deg > most_deg || !(mode.fps > 0)) return;
  const double frame_deg = *o.speed_deg_s / mode.fps;
  constexpr double same = 1e-6;
  const double frames = std::ceil(*o.every_deg / frame_deg - same);  // between the views that are furthest apart
  if (frames * frame_deg <= most_deg + same) return;
  const double nearest_deg = std::floor(*o.every_deg / frame_deg) * frame_deg;
  throw Error{Fault::usage, "--view-step: at " + format_number(*o.speed_deg_s, 6) + " deg/s and " +
                                format_number(mode.fps, 6) + " frames/s, views at multiples of " +
                                format_number(*o.every_deg, 6) + " deg are up to " +
                                format_number(frames * frame_deg, 6) + " deg apart, and vam-ost allows 15; give " +
                                (nearest_deg > 0 ? "--view-step " + format_number(nearest_deg, 6) + ", or " : "") +
                                "--fps " + format_number(*o.speed_deg_s * frames / *o.every_deg, 6)};
}

std::unique_ptr<device::AngleSource> open_angles(const Options& o, const device::CapturePlan& plan) {
  if (!o.follow.empty()) {
    const double never = std::numeric_limits<double>::infinity();
    const double last_deg = o.every_deg ? (static_cast<double>(plan.frames) - 0.5) * *o.every_deg : never;
    return device::followed_angle(o.follow, device::real_clock(), last_deg);
  }
  if (o.speed_deg_s) return device::elapsed_angle(*o.speed_deg_s, device::real_clock());
  if (o.angle_deg) return device::standing_angle(*o.angle_deg);
  return nullptr;
}

std::string device_of(const Options& o, const model::Printer& printer) {
  return o.device.empty() ? printer.camera.device : o.device;
}

bool is_recording(const std::string& device) { return device.rfind("replay:", 0) == 0; }

void check(const cli::App& app, const Options& o, const model::Printer& printer) {
  if (o.every_deg && o.follow.empty() && !o.speed_deg_s && !is_recording(device_of(o, printer))) {
    throw Error{Fault::usage, "--view-step: camera frames have no angles; give --follow or --speed"};
  }
  if (is_folder(o.output)) app.require_for("folders", o.output);
  if (is_folder(o.output) || o.live || o.frames || o.every_deg) return;
  throw Error{Fault::usage,
              "--frames: required for a stack, whose header states the number of images; give it, --live or a folder"};
}

// What was lost is reported, whatever else happens; what is missing is an error.
void conclude(const Options& o, const device::CaptureTally& tally, long wanted) {
  std::string lost;
  if (tally.dropped + tally.incomplete > 0) {
    lost = std::to_string(tally.dropped) + " frames dropped and " + std::to_string(tally.incomplete) + " incomplete";
  }
  if (tally.missing > 0) {
    const std::string remedy =
        is_folder(o.output) ? "repeat the command to capture them" : "a folder (-o views/) keeps the captured frames";
    throw Error{Fault::busy, o.output + ": " + std::to_string(tally.missing) + " of " + std::to_string(wanted) +
                                 " frames are missing" + (lost.empty() ? "" : " (" + lost + ")") + "; " + remedy};
  }
  if (!lost.empty()) warn(lost);
}

// That of the options and the printer file, with their settings.
std::unique_ptr<device::Camera> open_camera(const cli::App& app, const Options& options,
                                            const model::Printer& printer) {
  const std::string device = device_of(options, printer);
  if (is_recording(device)) app.require_for("recordings", device);
  device::CameraSettings settings = options.camera;
  if (!is_recording(device)) {
    settings.exposure_us = settings.exposure_us.value_or(printer.camera.exposure_us);
    settings.fps = settings.fps.value_or(printer.camera.fps);
    settings.binning = settings.binning.value_or(printer.camera.binning);
    settings.stamp = printer.camera.stamp;
    if (!settings.gain) settings.gain = printer.camera.gain;
    if (!settings.black_level) settings.black_level = printer.camera.black_level;
  }
  return device::open_camera(device, settings, {open_recording, printer, {}}, device::real_clock());
}

}  // namespace

void identify(const cli::App& app, const Options& options) {
  device::print_line(facts(*open_camera(app, options, session::load_printer(options.printer))).dump(2));
}

void take(const cli::App& app, const Options& options) {
  const model::Printer printer = session::load_printer(options.printer);
  check(app, options, printer);
  const device::CapturePlan plan = plan_of(options, printer);
  device::EventLog log(options.log);
  const auto angles = open_angles(options, plan);
  const auto camera = open_camera(app, options, printer);
  require_near_views(options, camera->mode());
  const auto store = open_store(app, options, printer, *camera, plan.frames);
  Json about = facts(*camera);
  about["lag_ms"] = 1e3 * plan.latency_s;
  log("begin", about);
  Progress progress("capturing", plan.frames);
  double shown_s = -std::numeric_limits<double>::infinity();
  const device::CaptureSink sink{[&](long place) { return store->wanted(place); },
                                 [&](device::Shot&& shot) {
                                   if (!shot.frame.complete)
                                     log("incomplete", {{"number", shot.frame.number}, {"place", shot.place}});
                                   if (!options.latest.empty() && shot.frame.time_s >= shown_s + 1) {
                                     shown_s = shot.frame.time_s;
                                     io::write_png(options.latest, shot.frame.levels);
                                   }
                                   store->keep(std::move(shot));
                                   progress.tick();
                                 },
                                 [&](long first, long last) {
                                   log("dropped", {{"first", first}, {"last", last}});
                                   store->dropped(first, last);
                                 }};
  const bool nothing_to_do = [&] {
    for (long place = 0; place < plan.frames; ++place) {
      if (store->wanted(place)) return false;
    }
    return plan.frames > 0;
  }();
  device::CaptureTally tally;
  try {
    if (!nothing_to_do) tally = device::capture(*camera, angles.get(), plan, sink);
  } catch (const device::Interrupted&) {  // the usual end of a capture without a number of frames
    store->close();
    throw;
  }
  store->close();
  log("end", device::to_json(tally));
  conclude(options, tally, plan.frames);
  store->commit();
  Json report = about;
  report.update(device::to_json(tally));
  io::write_report(options.report, "vam-capture", report);
}

}  // namespace vam::capture_tool
