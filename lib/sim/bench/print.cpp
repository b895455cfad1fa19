// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/bench/print.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/distributions.hpp"
#include "sim/bench/private/deposit.hpp"

namespace vam::sim {

namespace {

constexpr double reaction_s = 0.25;  // steps of the resin

SimResin resin_of(const SimBench& bench) {
  if (!bench.resin) throw Error{Fault::usage, "simulated print: the bench has no resin"};
  SimResin resin = *bench.resin;
  if (!(bench.printer.resin.absorption_per_mm > 0) || !bench.printer.resin.critical_dose_mj_cm3) {
    throw Error{Fault::usage,
                "printer: a resin that cures has resin.absorption_per_mm and resin.critical_dose_mj_cm3; set both"};
  }
  resin.critical_dose_mj_cm3 = *bench.printer.resin.critical_dose_mj_cm3;
  resin.dose_diffusion_mm2_s = bench.printer.resin.diffusion_mm2_s;
  return resin;
}

// What both the projector lights and the camera sees.
model::Grid grid_of(const SimBench& bench) {
  const auto& projector = bench.printer.projector;
  const double voxel_mm = bench.resin->voxel_mm;
  const double seen_mm = 0.5 * bench.rows * bench.printer.camera.pixel_mm;
  const double low_mm = std::max(-seen_mm, -(projector.rows - 0.5 - projector.axis_row) * projector.pixel_mm);
  const double high_mm = std::min(seen_mm, (projector.axis_row + 0.5) * projector.pixel_mm);
  const int across = 2 * ceil_int(lit_radius_mm(bench.printer) / voxel_mm) + 1;
  const int up = std::max(2, ceil_int((high_mm - low_mm) / voxel_mm));
  return model::centred_grid(across, across, up, voxel_mm, low_mm + 0.5 * voxel_mm);
}

double blur_mm(const SimBench& bench) {
  return std::hypot(bench.beam_mm, bench.focus_mm * std::tan(bench.divergence_deg * rad_per_deg)) /
         stats::fwhm_per_sigma;
}

}  // namespace

struct SimPrint::State {
  SimBench bench;
  model::Grid grid;
  Photoresin resin;
  Deposit deposit;
  double waiting_s = 0;  // since the resin's last step
  double lit_s = 0;

  explicit State(const SimBench& about)
      : bench(about),
        grid(grid_of(about)),
        resin(resin_of(about), grid),
        deposit(about.printer, grid, about.gamma, blur_mm(about)) {}

  void shine(const GreyImage& image, double angle_deg, double part_rad, double seconds) {
    const double seat_rad = (angle_deg - bench.wobble_deg) * rad_per_deg;
    const double aside_px = bench.wobble_mm * std::cos(seat_rad) / bench.printer.projector.pixel_mm;
    const double lamp = std::max(0.0, 1 + bench.lamp_drift_per_min / 60 * (lit_s + 0.5 * seconds));
    deposit.add(image, part_rad, bench.centre_px + aside_px, lamp * bench.printer.projector.max_intensity_mw_cm2,
                seconds, resin.absorbed());
    lit_s += seconds;
  }
};

SimPrint::SimPrint(const SimBench& bench) {
  (void)resin_of(bench);  // throws where something is missing, before the grid is made from it
  state_ = std::make_unique<State>(bench);
}
SimPrint::~SimPrint() = default;

const Photoresin& SimPrint::resin() const { return state_->resin; }
double SimPrint::lit_s() const { return state_->lit_s; }
double SimPrint::part_rad(double angle_deg) const {
  return state_->bench.printer.stage.direction * angle_deg * rad_per_deg;
}

void SimPrint::pass(const GreyImage* image, double angle_deg, double seconds) {
  State& s = *state_;
  while (seconds > 0) {
    const double step_s = std::min(seconds, reaction_s - s.waiting_s);
    if (image != nullptr) s.shine(*image, angle_deg, part_rad(angle_deg), step_s);
    seconds -= step_s;
    s.waiting_s += step_s;
    if (s.waiting_s < (1 - 1e-9) * reaction_s) continue;
    if (s.lit_s > 0) s.resin.react(s.waiting_s);
    s.waiting_s = 0;
  }
}

std::vector<SimView> play_turn(const SimBench& bench, const SimScene& scene, SimPrint& print,
                               const std::vector<GreyImage>& frames, int views, long first) {
  const double turn_s = 360 / bench.printer.stage.speed_deg_s;
  const int steps = count_of(frames);
  std::vector<SimView> seen;
  for (int k = 0; k < steps; ++k) {
    const double middle_deg = 360 * (k + 0.5) / steps;
    print.pass(&frames[k], middle_deg, turn_s / steps);
    for (int due = count_of(seen); due < views && 360.0 * (due + 0.5) / views <= 360.0 * (k + 1) / steps; ++due) {
      const double angle_deg = 360 * (due + 0.5) / views;
      const SimMoment moment{angle_deg, nullptr, print.lit_s(), 1, &print};
      seen.push_back({angle_deg, scene.render(moment, bench.printer.camera.exposure_us, first + due)});
    }
  }
  return seen;
}

}  // namespace vam::sim
