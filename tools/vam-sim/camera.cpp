// SPDX-License-Identifier: GPL-3.0-or-later
// vam-sim camera: a GigE Vision camera that views a simulated vial, on a network address of this machine.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "cli/app.hpp"
#include "device/os/interrupt.hpp"
#include "device/port/lines.hpp"
#include "io/exr/stack.hpp"
#include "io/image/any_frames.hpp"
#include "io/vdb/vdb.hpp"
#include "optics/patterns.hpp"
#include "optics/projector_frames.hpp"
#include "session/exposure.hpp"
#include "session/printer.hpp"
#include "sim/cameras/gv_camera.hpp"
#include "sim/cameras/makers.hpp"
#include "sim/controllers/controllers.hpp"
#include "vam-sim/commands.hpp"

namespace vam::sim_tool {

namespace {

struct CameraOptions {
  sim::SimCameraSettings camera;
  std::string address = "127.0.0.1";
  std::string serial = "VAM1";
  std::string part;
  std::string frames;
  optics::PatternPlan pattern;
  std::optional<int> pitch_px, width_px;  // its lines
  std::string stamp;
  bool no_latch = false;
  std::optional<double> glow;
  double lag_ms = 0, latency_ms = 0;
  std::string drop, incomplete;
  std::optional<int> unplug, shrink;
  std::string log;
  bool cure = false;
  sim::SimResin resin;
  std::optional<double> cure_delay_s;
  std::string cured;
  cli::PrinterOptions printer;
  bool with_parent = false;
};

void declare_scene(cli::App& app, CameraOptions& o) {
  app.group("Scene");
  app.option("--part", "BODIES", o.part,
             "Shape of the print, e.g. 'sphere:x=2,diameter=4;cylinder:diameter=6,height=3'.");
  app.option("--lit", "S", o.camera.bench.lit_s, cli::non_negative,
             "Exposed time that completes the print, whose volume grows in proportion; 0: complete from the start.");
  app.option("--follow", "FILE", o.camera.sources.angles, "Read the stage angle from this log of vam-sim stage.");
  app.option("--speed", "DEG/S", o.camera.sources.speed_deg_s, {-1000, 1000}, "Without --follow: stage speed.");
  app.option("--flips", "FILE", o.camera.sources.shown, "Log of vam-project: which frame was on and when.");
  app.option("--projected", "FILE", o.frames,
             "Frames shown by vam-project: an EXR frame stack, video or folder of images.")
      .excludes({"--pattern"});
}

void declare_resin(cli::App& app, CameraOptions& o) {
  app.group("Resin", {"--cure"});
  app.flag("--cure", o.cure, "The print is what the light has cured, instead of --part.");
  app.option("--cure-voxel", "MM", o.resin.voxel_mm, {0.02, 2}, "Edge of a voxel of the resin.");
  app.option("--induction", "FRACTION", o.resin.induction, {0, 0.99},
             "Fraction of the critical dose that the inhibitor takes.");
  app.option("--inhibition-gradient", "FRACTION", o.resin.inhibition_gradient, {-2, 2},
             "Relative change of the inhibitor from the bottom to the top of the voxels.");
  app.option("--inhibitor-diffusion", "MM2/S", o.resin.inhibitor_diffusion_mm2_s, {0, 1},
             "Diffusion coefficient of the inhibitor.");
  app.option("--cure-delay", "S", o.cure_delay_s, {0, 1e4}, "Lifetime of radicals, by which curing follows the light.")
      .default_is("resin.dose_lifetime_s, or 3");
  app.option("--lamp-drift", "1/MIN", o.camera.bench.lamp_drift_per_min, {-10, 10},
             "Relative change of the lamp's intensity per minute of light.");
  app.option("--cured", "FILE.vdb", o.cured,
             "Rewrite this volume at every quarter turn: conversion relative to the gel point, solid from 1.")
      .writes({".vdb"});
}

void declare_pattern(cli::App& app, CameraOptions& o) {
  app.group("Test pattern");
  o.pattern.name.clear();
  app.option("--pattern", "NAME", o.pattern.name, "Test pattern shown by vam-project.");
  app.option("--pitch", "PX", o.pitch_px, {1, 100000}, "Pitch of grid lines, and step of the sweep.")
      .default_is("16; 4 for sweep");
  app.option("--width", "PX", o.width_px, {1, 100000}, "Width of lines.").default_is("1; 4 for sweep");
  app.option("--grey", "FRACTION", o.pattern.level, {0, 1},
             "Grey level of lines and fields, as a fraction of full grey.");
  app.option("--steps", "N", o.pattern.steps, {2, 65536}, "Levels of the ramp.");
}

void declare_misalignment(cli::App& app, sim::SimBench& bench) {
  app.group("Misalignment");
  app.option("--axis-offset", "PX", bench.axis_column, {-4096, 4096},
             "Offset of the rotation axis from the centre of the sensor, in columns, positive to the right "
             "(camera.axis_column counts from the left edge).");
  app.option("--tilt", "DEG", bench.tilt_deg, {-30, 30}, "Tilt of the axis, positive with its lower end to the right.");
  app.option("--centre", "PX", bench.centre_px, {-4096, 4096},
             "Offset of the vial's centre from projector.axis_column, in projector columns.");
  app.option("--wobble", "MM", bench.wobble_mm, {0, 100}, "Distance of the vial's axis from the rotation axis.");
  app.option("--wobble-phase", "DEG", bench.wobble_deg, {-360, 360},
             "Stage angle at which the vial is displaced towards higher projector columns.");
}

void declare_projector(cli::App& app, CameraOptions& o) {
  auto& bench = o.camera.bench;
  app.group("Projector");
  app.option("--beam", "MM", bench.beam_mm, {0, 10}, "Width of a pixel's beam in focus, full width at half maximum.");
  app.option("--focus", "MM", bench.focus_mm, {-1000, 1000}, "Position of the focus along the beam, from the axis.");
  app.option("--divergence", "DEG", bench.divergence_deg, {0, 45},
             "Increase of the beam's width with the distance from the focus, as an angle.");
  app.option("--projector-gamma", "N", bench.gamma, {0.1, 10}, "Intensity = (grey / full grey) to this power.");
  app.option("--vignetting", "FRACTION", bench.vignetting, {0, 1},
             "Relative loss of intensity at the corners of the image.");
  app.option("--latency", "MS", o.latency_ms, {0, 1000}, "Delay from a flip to its light.");
  app.option("--glow", "FRACTION", o.glow, {0, 10000},
             "Fluorescence of a fully lit vial in an exposure of 20 ms, as a fraction of full scale; a thin line needs "
             "a larger value.")
      .default_is("0.6; 0 with --cure");
  app.flag("--card", bench.card, "Uniform card in place of the vial, lit by the mean of the image.");
}

void declare_camera(cli::App& app, CameraOptions& o) {
  auto& bench = o.camera.bench;
  app.group("Camera");
  app.choice("--maker", o.camera.maker, sim::sim_maker_names(), "Maker whose identity and time stamps are simulated.");
  app.choice("--stamp", o.stamp, {"start", "middle", "end"},
             "Moment of the exposure that time stamps name, before --lag.")
      .default_is("as documented by the maker");
  app.option("--lag", "MS", o.lag_ms, {-1000, 1000}, "Delay of the time stamps from that moment.");
  app.flag("--no-latch", o.no_latch, "The clock cannot be latched.");
  app.option("--address", "IP", o.address, "Address of this machine to serve on.");
  app.option("--serial", "TEXT", o.serial, "Serial number.");
  app.option("--columns", "PX", bench.columns, {8, 2048}, "Sensor columns, at a pitch of camera.pixel_mm.");
  app.option("--rows", "PX", bench.rows, {8, 2048}, "Sensor rows.");
  app.option("--background", "FRACTION", bench.background, {0, 1}, "Background, as a fraction of full scale.");
  app.option("--noise", "FRACTION", bench.noise, {0, 1}, "Standard deviation of noise, as a fraction of full scale.");
  app.option("--specks", "N", bench.specks, {0, 10000}, "Bright and dark specks that stay where they are.");
}

void declare_faults(cli::App& app, CameraOptions& o) {
  app.group("Faults");
  app.option("--drop", "FRAMES", o.drop, "Frames that are dropped, e.g. 3,7.");
  app.option("--incomplete", "FRAMES", o.incomplete, "Frames that arrive incomplete, e.g. 3,7.");
  app.option("--unplug", "N", o.unplug, {0, 1e9}, "Disconnect before this frame.");
  app.option("--shrink", "N", o.shrink, {1, 1e9}, "From this frame on, send images of half the agreed height.");
}

void declare(cli::App& app, CameraOptions& o) {
  declare_scene(app, o);
  declare_resin(app, o);
  declare_pattern(app, o);
  declare_misalignment(app, o.camera.bench);
  declare_projector(app, o);
  declare_camera(app, o);
  declare_faults(app, o);
  app.group("Program");
  app.option("--seed", "N", o.camera.bench.seed, {0, 1e9}, "Seed of the random numbers.");
  app.option("--log", "FILE", o.log, "Append one JSON line per event; - is standard error.");
  app.flag("--die-with-parent", o.with_parent, "Exit when the parent process exits.");
  cli::add_printer(app, o.printer);
  app.usual({"--part", "--lit", "--follow", "--speed", "--cure", "--cured", "--pattern", "--card", "--maker",
             "--address", "--noise", "--seed", "--log", "--printer", "--set"});
}

std::vector<GreyImage> read_images(const std::string& path) {
  const auto source = io::open_images(path, io::file_type(path));
  std::vector<GreyImage> images;
  Image image;
  model::ImageInfo about;
  while (source->next(image, about)) {
    GreyImage& grey = images.emplace_back(image.width, image.height, 8);
    for (std::size_t i = 0; i < image.size(); ++i) {
      grey.values[i] = static_cast<std::uint16_t>(std::lround(255 * std::clamp(image.values[i], 0.0F, 1.0F)));
    }
  }
  return images;
}

std::vector<GreyImage> images(const optics::PatternPlan& pattern, const model::Projector& projector) {
  std::vector<GreyImage> shown;
  for (int n = 0; n < optics::pattern_frames(pattern, projector); ++n) {
    shown.push_back(optics::pattern_frame(pattern, projector, n));
  }
  return shown;
}

// As vam-project --pattern logs it.
optics::PatternPlan pattern_of(const Json& event) {
  optics::PatternPlan plan;
  plan.name = event.value("name", plan.name);
  plan.level = event.value("level", plan.level);
  plan.pitch_px = event.value("pitch_px", plan.pitch_px);
  plan.width_px = event.value("width_px", plan.width_px);
  plan.steps = event.value("steps", plan.steps);
  return plan;
}

std::vector<GreyImage> images(const CameraOptions& o, const model::Projector& projector) {
  if (!o.frames.empty()) {
    auto read = read_images(o.frames);
    for (const auto& image : read) {
      if (image.width == projector.columns && image.height == projector.rows) continue;
      throw Error{Fault::data, o.frames + ": frames of " + std::to_string(image.width) + " x " +
                                   std::to_string(image.height) + " pixels, but the projector has " +
                                   std::to_string(projector.columns) + " x " + std::to_string(projector.rows)};
    }
    return read;
  }
  return o.pattern.name.empty() ? std::vector<GreyImage>{} : images(o.pattern, projector);
}

// The light cures the resin; the true state is written for whoever judges.
void cure(const cli::App& app, CameraOptions& o) {
  auto& camera = o.camera;
  camera.bench.resin = o.resin;
  const auto& lifetime_s = camera.bench.printer.resin.dose_lifetime_s;  // as plans have it
  camera.bench.resin->delay_s = o.cure_delay_s.value_or(lifetime_s.value_or(o.resin.delay_s));
  camera.bench.glow = 0;              // its filter
  (void)sim::SimPrint(camera.bench);  // a printer that does not do ends the program before it serves a camera
  if (o.cured.empty()) return;
  camera.cured = [&app, &o](const sim::SimPrint& print) {
    const model::Volume volume = print.resin().conversion();
    io::SparseVolume written("conversion", volume.grid);
    written.history = {app.history()};
    written.units = "conversion of the gel point";
    written.write_slices(0, volume.grid.nz, volume.values.data());
    io::write_volume(o.cured, written);
  };
}

// What vam-project shows of a sinogram in one turn, so many frames; 0: one for each angle. full_scale: instead of that
// of the exposure; 0: none. Of 8 bits, by a linear response.
std::vector<GreyImage> sinogram_frames(const std::string& path, const model::Printer& printer, int frames,
                                       double full_scale) {
  io::StackReader reader(path);
  optics::FrameComposer composer(path, reader.info(), optics::frame_place(printer.projector, 0, 0));
  Image slice;
  for (model::ImageInfo about; reader.next(slice, about);) composer.add(slice, about.z_mm);
  composer.check();
  if (!(full_scale > 0)) {
    full_scale = session::exposure_of(path, reader.info(), printer, static_cast<double>(composer.peak())).full_scale;
  }
  std::vector<GreyImage> made;
  const int count = frames > 0 ? frames : reader.info().height;
  const double step_deg = 360.0 / count;
  for (int n = 0; n < count; ++n) {
    const Image light = composer.frame(n * step_deg, step_deg);
    GreyImage& grey = made.emplace_back(light.width, light.height, 8);
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double share = static_cast<double>(light.values[i]) / full_scale;
      grey.values[i] = static_cast<std::uint16_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
    }
  }
  return made;
}

// A signal ends it at once: nothing needs a safe state, and waiting for the threads of Aravis may never end.
void run(const cli::App& app, CameraOptions& o) {
  if (session::print_printer(o.printer)) return;
  optics::set_lines(o.pattern, o.pitch_px, o.width_px);
  if (o.with_parent) device::end_with_parent();
  auto& camera = o.camera;
  camera.bench.printer = session::load_printer(o.printer);
  if (!o.part.empty()) camera.bench.bodies = sim::parse_bodies(o.part);
  camera.sources.images = images(o, camera.bench.printer.projector);
  camera.sources.draw = [&camera](const Json& event) {
    return images(pattern_of(event), camera.bench.printer.projector);
  };
  camera.sources.renew = [&camera](const Json& event, int frames) {
    return sinogram_frames(event.value("sinogram", ""), camera.bench.printer, frames, event.value("full_scale", 0.0));
  };
  if (o.cure) cure(app, o);
  if (o.glow) camera.bench.glow = *o.glow;
  camera.lag_s = 1e-3 * o.lag_ms;
  camera.sources.latency_s = 1e-3 * o.latency_ms;
  camera.latch = !o.no_latch;
  if (!o.stamp.empty()) camera.stamp = device::stamp_moment(o.stamp, "");
  camera.drop = sim::parse_frames(o.drop);
  camera.incomplete = sim::parse_frames(o.incomplete);
  camera.unplug = o.unplug.value_or(-1);
  camera.shrink = o.shrink.value_or(-1);
  const sim::SimGvCamera server(camera, o.address, o.serial, sim::file_sim_log(o.log));
  device::print_line(o.address);
  for (;;) device::real_clock().sleep_until(device::real_clock().now_s() + 3600);
}

}  // namespace

void add_camera(cli::App& app) {
  app.subcommand<CameraOptions>("camera", "simulate a GigE Vision camera beside the vial", declare, run);
}

}  // namespace vam::sim_tool
