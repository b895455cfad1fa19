// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/cameras/camera.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/fingerprint.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/camera/camera_backends.hpp"
#include "sim/controllers/controllers.hpp"

namespace vam::sim {

namespace {

SimCameraSettings settings_of(const device::Address& address, const device::CameraSettings& requested,
                              const device::CameraBench& room) {
  SimCameraSettings sim;
  SimBench& bench = sim.bench;
  bench.printer = room.printer;
  bench.columns = address.integer("columns", 8, 8192).value_or(bench.columns);
  bench.rows = address.integer("rows", 8, 8192).value_or(bench.rows);
  bench.axis_column = address.number("axis_offset", bench.axis_column, -4096, 4096);
  bench.tilt_deg = address.number("tilt", bench.tilt_deg, -30, 30);
  bench.centre_px = address.number("centre", bench.centre_px, -4096, 4096);
  bench.wobble_mm = address.number("wobble", bench.wobble_mm, 0, 100);
  bench.wobble_deg = address.number("wobble_phase", bench.wobble_deg, -360, 360);
  bench.beam_mm = address.number("beam", bench.beam_mm, 0, 10);
  bench.divergence_deg = address.number("divergence", bench.divergence_deg, 0, 45);
  bench.focus_mm = address.number("focus", bench.focus_mm, -1000, 1000);
  bench.card = address.integer("card", 0, 1).value_or(0) == 1;
  bench.glow = address.number("glow", bench.glow, 0, 1e4);
  bench.gamma = address.number("projector_gamma", bench.gamma, 0.1, 10);
  bench.vignetting = address.number("vignetting", bench.vignetting, 0, 1);
  bench.background = address.number("background", bench.background, 0, 1);
  bench.noise = address.number("noise", bench.noise, 0, 1);
  bench.lit_s = address.number("lit", bench.lit_s, 0, 1e6);
  bench.seed = address.integer("seed", 0, 1000000000).value_or(bench.seed);
  if (address.options.contains("part")) bench.bodies = parse_bodies(address.word("part", ""));
  sim.sources.speed_deg_s = address.number("speed", 0, -1000, 1000);
  sim.sources.angles = address.word("follow", "");
  sim.sources.shown = address.word("flips", "");
  sim.sources.images = room.images;
  sim.fps = requested.fps.value_or(sim.fps);
  sim.exposure_us = requested.exposure_us.value_or(sim.exposure_us);
  sim.bits = address.integer("bits", 8, 16).value_or(sim.bits);
  sim.lag_s = 1e-3 * address.number("lag", 0, -1000, 1000);
  sim.drop = parse_frames(address.word("drop", ""));
  sim.incomplete = parse_frames(address.word("incomplete", ""));
  sim.unplug = address.integer("unplug", 0, 1000000000).value_or(-1);
  sim.shrink = address.integer("shrink", 1, 1000000000).value_or(-1);
  if (sim.bits != 8 && sim.bits != 16) throw Error{Fault::usage, "device '" + address.text + "': bits=8 or bits=16"};
  return sim;
}

// Frame k is taken at start + k / fps, the middle of its exposure, and comes half an exposure later.
class SimCamera final : public device::Camera {
 public:
  SimCamera(SimCameraSettings sim, const device::CameraSettings& requested, bool in_step, SimLog log,
            device::Clock& clock)
      : sim_(std::move(sim)),
        binning_(requested.binning.value_or(1)),
        triggered_(requested.trigger == "software"),
        in_step_(in_step),
        log_(std::move(log)),
        clock_(clock),
        scene_(sim_.bench, binning_, sim_.bits) {}

  Json identify() override {
    return {{"maker", "VAM tools (simulated)"},
            {"model", "camera"},
            {"serial", std::to_string(sim_.bench.seed)},
            {"simulated", true}};
  }
  device::CameraMode mode() const override {
    device::CameraMode mode;
    mode.columns = scene_.columns();
    mode.rows = scene_.rows();
    mode.bits = sim_.bits;
    mode.exposure_us = sim_.exposure_us;
    mode.fps = sim_.fps;
    mode.binning = binning_;
    return mode;
  }
  void start() override {
    start_s_ = clock_.now_s();
    world_.emplace(sim_.sources, start_s_);
  }
  void trigger() override {
    if (!triggered_) throw Error{Fault::usage, "sim: not in trigger mode; select the software trigger"};
    trigger_s_ = clock_.now_s();
  }

  std::optional<device::CapturedFrame> next() override {
    for (;;) {
      device::CapturedFrame frame;
      frame.number = next_++;
      frame.time_s = start_s_ + static_cast<double>(frame.number) / sim_.fps;
      if (triggered_) {
        if (!trigger_s_) throw Error{Fault::busy, "sim: no frame, since no trigger was sent"};
        frame.time_s = *std::exchange(trigger_s_, std::nullopt) + 0.5e-6 * sim_.exposure_us;
      }
      if (in_step_) clock_.sleep_until(frame.time_s + 0.5e-6 * sim_.exposure_us);
      clock_.sleep_until(0);  // a signal ends this, too
      if (frame.number == sim_.unplug)
        throw Error{Fault::absent, "sim: the camera is disconnected; check cable and power"};
      if (frame.number == sim_.shrink) {
        const auto other = device::another_size(mode(), scene_.columns(), scene_.rows() / 2);
        throw Error{Fault::protocol, "sim: sends images of " + *other + "; run it again"};
      }
      if (sim_.drop.contains(frame.number) && !triggered_) continue;
      const double middle_s = frame.time_s - sim_.lag_s;
      const double half_s = 0.5e-6 * sim_.exposure_us;
      frame.levels =
          scene_.render(world_->during(middle_s - half_s, middle_s + half_s), sim_.exposure_us, frame.number);
      const SimMoment moment = world_->moment(middle_s);
      frame.device_s = frame.time_s - start_s_;
      if (log_) {
        log_({{"t_monotonic_s", frame.time_s},
              {"event", "frame"},
              {"number", frame.number},
              {"angle_deg", moment.angle_deg},
              {"lit_s", moment.lit_s},
              {"levels", fingerprint(frame.levels)}});
      }
      if (sim_.incomplete.contains(frame.number)) {
        frame.complete = false;
        const auto half = frame.levels.values.begin() + static_cast<std::ptrdiff_t>(frame.levels.values.size() / 2);
        std::fill(half, frame.levels.values.end(), std::uint16_t{0});
      }
      return frame;
    }
  }

 private:
  SimCameraSettings sim_;
  int binning_;
  bool triggered_;
  bool in_step_;
  SimLog log_;
  device::Clock& clock_;
  SimScene scene_;
  std::optional<SimWorld> world_;
  std::optional<double> trigger_s_;
  double start_s_ = 0;
  long next_ = 0;
};

}  // namespace

std::set<long> parse_frames(const std::string& text) {
  std::set<long> numbers;
  for (const auto& word : split(text, ',')) {
    const auto value = parse_number(word);
    if (!value || *value < 0 || *value > 1e9 || *value != std::floor(*value)) {
      throw Error{Fault::usage,
                  "frames '" + text + "': '" + word + "' is not a frame number; expected a list like 3,7"};
    }
    numbers.insert(static_cast<long>(*value));
  }
  return numbers;
}

std::unique_ptr<device::Camera> open_sim_camera(const device::Address& address, const device::CameraSettings& settings,
                                                const device::CameraBench& bench, device::Clock& clock) {
  if (!address.place.empty()) throw Error{Fault::usage, "device '" + address.text + "': sim: takes no place"};
  if (settings.trigger != "free" && settings.trigger != "software") {
    throw Error{Fault::usage,
                "device '" + address.text + "': no trigger " + settings.trigger + "; available: software"};
  }
  if (settings.gain || settings.black_level || settings.gamma != 1 || !settings.format.empty()) {
    throw Error{Fault::usage, "device '" + address.text +
                                  "': has no setting for gain, gamma, black level or pixel format; omit them"};
  }
  SimCameraSettings sim = settings_of(address, settings, bench);
  const int binning = settings.binning.value_or(1);
  if (sim.bench.columns / binning < 1 || sim.bench.rows / binning < 1) {
    throw Error{Fault::usage, "device '" + address.text + "': binning leaves no pixel"};
  }
  return std::make_unique<SimCamera>(std::move(sim), settings, device::in_real_pace(address, "real"),
                                     file_sim_log(address.word("log", "")), clock);
}

}  // namespace vam::sim
