// SPDX-License-Identifier: GPL-3.0-or-later
// What a camera sees of a thin lit sheet, against the sum over all its columns.
#include "metrology/calibrate/private/sight_lines.hpp"

#include "base/constants.hpp"
#include "model/printer.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

struct Plane {
  double x = 0, y = 0;
};
double dot(Plane a, Plane b) { return a.x * b.x + a.y * b.y; }
Plane stepped(Plane from, double steps, Plane along) { return {from.x + steps * along.x, from.y + steps * along.y}; }

// Every column, far beyond the vial on either side, that sees the resin: what of the sheet lies on its line of sight.
double seen_by_all_columns(const model::Printer& printer, const optics::ChiefRay& ray) {
  const optics::View camera = optics::camera_view(printer);
  const double radius_mm = optics::resin_radius_mm(camera);
  const Plane light{-std::sin(ray.delta_rad), std::cos(ray.delta_rad)};
  const Plane foot{ray.x_v_mm * light.y, -ray.x_v_mm * light.x};
  const Plane entry = stepped(foot, -std::sqrt(radius_mm * radius_mm - ray.x_v_mm * ray.x_v_mm), light);
  constexpr int columns = 400000;
  const double width_mm = 4 * printer.vial.radius_mm / columns;
  double sum = 0;
  for (int i = 0; i < columns; ++i) {
    const auto sight = optics::chief_ray(camera, (i + 0.5) * width_mm - 2 * printer.vial.radius_mm);
    if (!sight.hits) continue;
    const double turn = sight.delta_rad + printer.camera.azimuth_deg * rad_per_deg;
    const Plane across{std::cos(turn), std::sin(turn)};
    const double slant = dot(across, light);
    const Plane crossing = stepped(entry, (sight.x_v_mm - dot(across, entry)) / slant, light);
    if (std::hypot(crossing.x, crossing.y) > radius_mm) continue;
    const double travelled_mm = std::hypot(crossing.x - entry.x, crossing.y - entry.y);
    sum += sight.transmittance * std::exp(-printer.resin.absorption_per_mm * travelled_mm) / std::abs(slant) *
           width_mm / (2 * radius_mm);
  }
  return ray.transmittance * sum;
}

}  // namespace

TEST_CASE("a sheet as wide as a matched vial is seen whole, but for what two windows reflect") {
  model::Printer printer;
  printer.bath.index = printer.vial.index_glass = printer.resin.index = printer.camera.index_resin = 1.5;
  printer.bath.window_mm = 20;
  printer.camera.telecentric = printer.projector.telecentric = true;
  const auto ray = optics::chief_ray(optics::projector_view(printer), 0);
  CHECK(metrology::SightLines(printer).seen(ray) == doctest::Approx(0.96 * 0.96).epsilon(1e-5));
}

TEST_CASE("a sheet in resin that the glass shows larger or smaller is seen by all columns") {
  for (const double bath_index : {1.0, 1.33, 1.6}) {
    CAPTURE(bath_index);
    model::Printer printer;
    printer.vial = {.radius_mm = 12.7, .wall_mm = 1, .index_glass = 1.47};
    printer.bath = {.index = bath_index, .window_mm = 20};
    printer.camera.index_resin = printer.resin.index = 1.53;
    printer.resin.absorption_per_mm = 0.03;
    const optics::View projector = optics::projector_view(printer);
    const metrology::SightLines sights(printer);
    for (const double x_p_mm : {-9.0, 0.0, 4.0, 9.5}) {
      CAPTURE(x_p_mm);
      const auto ray = optics::chief_ray(projector, x_p_mm);
      CHECK(sights.seen(ray) == doctest::Approx(seen_by_all_columns(printer, ray)).epsilon(1e-3));
    }
  }
}
