// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/make_operator.hpp"

#include <variant>

#include "lib/light/operator_checks.hpp"
#include "lib/light/vials.hpp"
#include "lib/optimize/parts.hpp"
#include "light/operators/private/attenuated_operator.hpp"
#include "light/operators/private/parallel_operator.hpp"
#include "light/operators/private/vial_operator.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::light;

namespace {

template <class Expected>
bool is(const std::unique_ptr<Operator>& light) {
  return dynamic_cast<const Expected*>(light.get()) != nullptr;
}

}  // namespace

TEST_CASE("the operator is that of the light: clear, absorbing, around an insert, through the vial") {
  const ParallelBeam clear{parts::turn(32, 20), 0, 16};
  const ParallelBeam absorbing{parts::turn(32, 20), 0.01, 16};
  const Slab insert(32, 32);
  CHECK(is<ParallelOperator>(make_operator(clear)));
  CHECK(is<AttenuatedOperator>(make_operator(absorbing)));
  CHECK(is<VialOperator>(make_operator(clear, {&insert, 1})));
  CHECK(is<VialOperator>(make_operator(absorbing, {&insert, 1})));
  CHECK(is<VialOperator>(make_operator(parts::vial_setup(32, 20))));
  CHECK(is<VialOperator>(make_operator(parts::vial_setup(32, 20), {&insert, 1})));
}

TEST_CASE("the disc correction does not apply around an insert, unless nothing is absorbed") {
  const Slab insert(32, 32);
  const ParallelBeam disc{parts::turn(32, 20), 0.01, 16, Correction::disc};
  CHECK(fault_of([&] { (void)make_operator(disc, {&insert, 1}); }) == Fault::usage);
  const ParallelBeam clear{parts::turn(32, 20), 0, 16, Correction::disc};
  CHECK(is<VialOperator>(make_operator(clear, {&insert, 1})));
}

TEST_CASE("Fourier slices are for light that is neither absorbed nor blocked") {
  const Slab insert(32, 32);
  ParallelBeam beam{parts::turn(32, 20)};
  beam.integrals = LineIntegrals::fourier;
  CHECK(is<ParallelOperator>(make_operator(beam)));
  CHECK(fault_of([&] { (void)make_operator(beam, {&insert, 1}); }) == Fault::usage);
  beam.mu_per_px = 0.01;
  CHECK(fault_of([&] { (void)make_operator(beam); }) == Fault::usage);
  CHECK(quicker_for(64, parts::turn(32, 20)) == LineIntegrals::footprints);
  CHECK(quicker_for(64, parts::turn(512, 360)) == LineIntegrals::fourier);
  CHECK(quicker_for(1, parts::turn(512, 360)) == LineIntegrals::fourier_of_one);
}

TEST_CASE("the light of a virtual sinogram is that of its columns, in voxels of the grid") {
  model::Printer printer;
  printer.resin.absorption_per_mm = 0.04;
  model::StackInfo info{.kind = model::Kind::sinogram,
                        .space = model::Space::virtual_,
                        .width = 20,
                        .height = 90,
                        .pixel_mm = 0.5,
                        .angle_start_deg = 30,
                        .angle_step_deg = 4};
  const model::Grid grid = model::centred_grid(16, 14, 3, 0.5);
  const auto of = [&] { return std::get<ParallelBeam>(beam_of(printer, {}, info, grid)); };
  const ParallelBeam beam = of();
  CHECK(beam.turn.nx == 16);
  CHECK(beam.turn.ny == 14);
  CHECK(beam.turn.columns == 20);
  CHECK(beam.turn.angles == 90);
  CHECK(beam.turn.axis_x == 7.5);
  CHECK(beam.turn.axis_y == 6.5);
  CHECK(beam.turn.angle_start_rad == doctest::Approx(std::numbers::pi / 6));
  CHECK(beam.turn.angle_step_rad == doctest::Approx(std::numbers::pi / 45));
  CHECK(beam.mu_per_px == doctest::Approx(0.02));
  CHECK(beam.resin_radius_px == doctest::Approx(2 * model::resin_radius_mm(printer.vial)));
  info.pixel_mm = 0.5 * 1.0009;
  CHECK(of().turn.columns == 20);
  info.pixel_mm = 0.5 * 1.0012;
  CHECK(fault_of([&] { (void)of(); }) == Fault::data);
  info.pixel_mm = 0.5;
  info.height = 89;  // not a turn
  CHECK(fault_of([&] { (void)of(); }) == Fault::data);
  info.space = model::Space::camera;
  CHECK(fault_of([&] { (void)of(); }) == Fault::data);
}

TEST_CASE("frames of a virtual projector that are held light what parallel light does at the angles between") {
  constexpr int size = 64, angles = 45, parts_of_step = 16;
  ParallelBeam beam{parts::turn(size, angles), 0.01, 40};
  const double step = beam.turn.angle_step_rad;
  const auto dose_of = [](const ParallelBeam& light) {
    const auto how = make_operator(light);
    Slab image(how->image().width, how->image().height), g(how->sinogram().width, how->sinogram().height);
    for (int a = 0; a < image.height; ++a) {
      for (int c = 0; c < image.width; ++c) *image.at(c, a) = static_cast<float>(1 + std::sin(0.8 * c + 2.3 * a));
    }
    how->collapse(image, g);
    return parts::dose_of(*how, g);
  };
  ParallelBeam held = beam;
  held.hold_rad = std::abs(step);
  CHECK(is<VialOperator>(make_operator(held)));
  const Slab dose = dose_of(held);
  std::vector<double> mean(dose.values.size());
  for (int part = 0; part < parts_of_step; ++part) {
    ParallelBeam turned = beam;
    turned.turn.angle_start_rad += step * ((part + 0.5) / parts_of_step - 0.5);
    const Slab here = dose_of(turned);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += static_cast<double>(here.values[i]) / parts_of_step;
  }
  const Slab thin = dose_of(beam);
  double worst = 0, without = 0;
  for (int j = 0; j < size; ++j) {
    for (int i = 0; i < size; ++i) {
      if (std::hypot(i - 31.5, j - 31.5) > 28) continue;
      const double want = mean[static_cast<std::size_t>(dose.at(i, j) - dose.values.data())];
      worst = std::max(worst, std::abs(static_cast<double>(*dose.at(i, j)) - want));
      without = std::max(without, std::abs(static_cast<double>(*thin.at(i, j)) - want));
    }
  }
  CHECK(worst < 0.02);  // of some 6
  CHECK(without > 0.1);
  held.integrals = LineIntegrals::fourier;
  CHECK(fault_of([&] { (void)make_operator(held); }) == Fault::usage);
}
