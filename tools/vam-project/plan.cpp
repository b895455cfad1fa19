// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/plan.hpp"

#include <string>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/open/open.hpp"
#include "device/os/clock.hpp"
#include "device/port/lines.hpp"
#include "vam-project/match.hpp"
#include "vam-project/print.hpp"
#include "vam-project/turn.hpp"

namespace vam::project {

namespace {

void say(std::string name, const std::string& text) {
  constexpr std::size_t column = 11;
  device::print_line(name.append(column - name.size(), ' ') + text);
}

// The lit columns of the sinogram as floats, each frame as grey, a byte a pixel, and two images as a screen takes them.
double memory_mb(const model::StackInfo& info, const model::Projector& projector, int frames) {
  const double sinogram = 4.0 * info.width * info.height * info.count;
  return 1e-6 * (sinogram + (frames + 2 * 4.0) * projector.columns * projector.rows);
}

std::string dose_text(const session::Exposure& exposure, double turns, const model::Resin& resin) {
  if (!exposure.share && session::relative_without(resin).empty()) return "relative without a plan of vam-optimize";
  if (!exposure.share) return session::relative_without(resin);
  const double share = *exposure.share * turns / exposure.turns;
  return format_number(share, 3) +
         " of the planned dose, the critical one at the threshold of the sinogram, which is " + "reached after " +
         format_number(turns / share, 4) + " turns";
}

std::string identity_text(const Json& identity) {
  std::string text;
  for (const char* key : {"maker", "model", "serial"}) {
    if (identity.contains(key) && identity[key].is_string()) text += " " + identity[key].get<std::string>();
  }
  return text;
}

}  // namespace

void print_plan(const cli::App& app, const Options& options, const model::Printer& printer, io::StackReader& reader) {
  const model::StackInfo info = reader.info();
  app.require_for(info.kind == model::Kind::frames ? "slices" : "sinograms", options.input);
  require_printer(options, info, printer);
  const auto exposure = whole_exposure(options, info, read_light(options, reader, printer.projector), printer);
  const double turns = exposure.turns - options.live.from_deg / 360;  // with light
  const int frames = options.live.frames_per_turn.value_or(info.height);
  const model::Projector& projector = printer.projector;
  say("frames", std::to_string(frames) + " per turn, " + std::to_string(projector.columns) + " x " +
                    std::to_string(projector.rows) + ", " + std::to_string(projector.bits) + " bits; at most " +
                    format_number(memory_mb(info, projector, frames * options.dither_turns.value_or(1)), 4) +
                    " MB of memory");
  const std::string dark =
      options.live.from_deg > 0 ? " from " + format_number(options.live.from_deg, 4) + " deg on" : std::string{};
  say("exposure", format_number(turns, 4) + (turns == 1 ? " turn" : " turns") + dark + " at " +
                      format_number(printer.stage.speed_deg_s) +
                      " deg/s: " + format_number(model::seconds_of(printer.stage, turns), 4) + " s of light");
  say("intensity", "at most " + format_number(projector.max_intensity_mw_cm2) + " mW/cm2, for the sinogram value " +
                       format_number(exposure.full_scale, 4));
  say("dose", dose_text(exposure, turns, printer.resin));
  print_devices(options, printer);
}

void print_devices(const Options& options, const model::Printer& printer) {
  device::Guardian guardian;
  const auto display = device::open_display(options.output, {printer.projector.columns, printer.projector.rows, 60},
                                            device::real_clock(), &guardian);
  const auto mode = display->mode();
  if (mode.columns != printer.projector.columns || mode.rows != printer.projector.rows) {
    throw Error{Fault::data, options.output + ": has " + std::to_string(mode.columns) + " x " +
                                 std::to_string(mode.rows) + " pixels, but the printer file " +
                                 std::to_string(printer.projector.columns) + " x " +
                                 std::to_string(printer.projector.rows) +
                                 "; set projector.columns and rows, or the mode of the display"};
  }
  say("display", options.output + " " + std::to_string(mode.columns) + " x " + std::to_string(mode.rows) + " at " +
                     format_number(mode.hz, 4) + " Hz");
  if (const auto relay = device::open_relay(options.live.relay, &guardian)) {
    say("relay", options.live.relay + ", opens " + format_number(relay->identify()["limit_ms"]) +
                     " ms after the last heartbeat");
  } else {
    say("relay", "none (projector.relay): nothing switches the lamp off when this machine fails");
  }
  if (options.live.light.empty()) return say("engine", "none (--light not given)");
  const auto light = device::open_light(options.live.light, options.live.max_led_current_percent, &guardian);
  say("engine", options.live.light + identity_text(light->identify()));
}

}  // namespace vam::project
