// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/blurred_operator.hpp"

#include "lib/light/operator_checks.hpp"
#include "lib/light/vials.hpp"
#include "lib/optimize/parts.hpp"
#include "light/blur/blur_stream.hpp"
#include "light/operators/private/parallel_operator.hpp"
#include "optimize/methods/metrics.hpp"
#include "oracle/part_2d.hpp"
#include "oracle/ray_tracer.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;
using parts::dot;
using parts::vial_setup;

namespace {

std::vector<Slab> noise(Shape shape, std::size_t count, int used, unsigned seed) {
  std::vector<Slab> slabs;
  for (std::size_t s = 0; s < count; ++s) {
    slabs.push_back(parts::noise(shape, seed + static_cast<unsigned>(s)));
    for (std::size_t i = 0; i < slabs[s].values.size(); ++i) {
      if (s * lanes + i % lanes >= static_cast<std::size_t>(used)) slabs[s].values[i] = 0.0F;
    }
  }
  return slabs;
}

double dot_all(const std::vector<Slab>& a, const std::vector<Slab>& b) {
  double sum = 0;
  for (std::size_t s = 0; s < a.size(); ++s) sum += dot(a[s], b[s]);
  return sum;
}

std::vector<vam::Image> images(const Slab& slab) {
  std::vector<vam::Image> all;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    vam::Image image(slab.width, slab.height);
    for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = slab.values[i * lanes + lane];
    all.push_back(image);
  }
  return all;
}

/// The judge's blur on the sharp dose of these projections: figures of the slices, each at its best threshold.
std::vector<vam::model::DoseMetrics> judged(const Operator& sharp, const std::vector<Slab>& g, const Problem& problem,
                                            double sigma_px) {
  std::vector<Slab> dose = slabs(g.size(), sharp.object().width, sharp.object().height);
  sharp.adjoint(g, dose);
  int k = 0;
  light::BlurStream blur(sigma_px, [&](const vam::Image& slice) {
    for (std::size_t i = 0; i < slice.values.size(); ++i) {
      dose[0].values[i * lanes + static_cast<std::size_t>(k)] = slice.values[i];
    }
    ++k;
  });
  for (auto& image : images(dose[0])) blur.push(image);
  blur.finish();
  return metrics(dose, problem);
}

void check_adjoint(const Operator& sharp) {
  const BlurredOperator light(sharp, 1.7, 21);
  const auto f = noise(light.object(), 2, 21, 1);
  const auto g = noise(light.sinogram(), 2, 21, 7);
  auto projected = slabs(2, light.sinogram().width, light.sinogram().height);
  auto dose = slabs(2, light.object().width, light.object().height);
  light.forward(f, projected);
  light.adjoint(g, dose);
  const double scale = std::sqrt(dot_all(projected, projected) * dot_all(g, g));
  CHECK(std::abs(dot_all(projected, g) - dot_all(f, dose)) < 1e-5 * scale);
}

}  // namespace

TEST_CASE("A and A* are adjoint with the blur between, also from slab to slab") {
  check_adjoint(ParallelOperator(parts::turn(48, 60)));
}

TEST_CASE("A and A* are adjoint with the blur between in the vial too, around an insert in an absorbing resin") {
  VialSetup setup = vial_setup(48, 60);
  setup.absorption_per_mm = 0.07;
  check_adjoint(VialOperator(setup));
  const auto drop = vam::oracle::draw(48, [](double x, double y) { return std::hypot(x - 8, y + 5) < 6; });
  std::vector<Slab> inserts(2, Slab(48, 48));
  for (Slab& insert : inserts) pack(drop.data(), 1, insert);
  check_adjoint(VialOperator(setup, inserts));
}

/// One row of a few columns in one slice makes a narrow beam. Where it goes, how wide it is and what Fresnel leaves of
/// it is traced; across it the blurred dose is a box times a Gaussian, from slice to slice the lattice's heat kernel
/// e^-t I_n(t) [LIN90].
TEST_CASE("a narrow beam through the vial has, blurred, the profile of light traced by Snell's law") {
  const int size = 256;
  const double sigma_px = 3;
  const VialSetup setup = vial_setup(size, 36);
  const VialOperator sharp(setup);
  const BlurredOperator light(sharp, sigma_px, lanes);
  vam::oracle::Bench bench{.lens_distance = 119.808L, .cylinders = {{12.7L, 1.53L}}};
  for (const auto& [column, row] : {std::pair{219, 0}, {160, 7}, {280, 20}}) {
    CAPTURE(column);
    Slab image(light.image().width, light.image().height);
    for (int c = column - 4; c <= column + 4; ++c) image.at(c, row)[5] = 1;  // slice 5
    Slab g(light.sinogram().width, light.sinogram().height);
    light.collapse(image, g);
    const Slab dose = parts::dose_of(light, g);

    const double x_p = setup.projector.x_mm(column);
    const double half_p = 4.5 * setup.projector.pixel_mm;
    const auto ray = vam::oracle::trace(bench, x_p);
    REQUIRE(ray);
    const auto line = vam::oracle::line_of(*ray);
    const auto t_of = [&](double x) {
      return static_cast<double>(vam::oracle::line_of(*vam::oracle::trace(bench, x)).t);
    };
    const double low = t_of(x_p - half_p);
    const double high = t_of(x_p + half_p);
    // Light of `transmittance` a mm of the projector's columns, on a beam high - low wide.
    const double within = setup.turn.step_rad * static_cast<double>(ray->transmittance) * 2 * half_p / (high - low);
    const double angle = static_cast<double>(line.a) + row * setup.turn.step_rad;
    const double sigma_mm = sigma_px * setup.grid.voxel_mm;
    const double time = sigma_px * sigma_px;
    for (const double off_mm : {-0.3, -0.1, 0.0, 0.15, 0.25}) {
      const double wanted_t = static_cast<double>(line.t) + off_mm;
      const auto voxel = [&](double along, double first) {
        return static_cast<int>(std::lround((along - first) / setup.grid.voxel_mm));
      };
      const int i = voxel(wanted_t * std::cos(angle), setup.grid.x_mm(0));
      const int j = voxel(wanted_t * std::sin(angle), setup.grid.y_mm(0));
      const double t = setup.grid.x_mm(i) * std::cos(angle) + setup.grid.y_mm(j) * std::sin(angle);  // of the voxel
      const auto share = [&](double edge) { return 0.5 * std::erf((edge - t) / (sigma_mm * std::numbers::sqrt2)); };
      for (const int n : {0, 2, 4}) {
        const double in_slice = std::exp(-time) * std::cyl_bessel_i(n, time);
        const double want = within * (share(high) - share(low)) * in_slice;
        // Light is linear between columns, which adds less than 1 % to the Gaussian's variance.
        CHECK(static_cast<double>(dose.at(i, j)[5 + n]) == doctest::Approx(want).epsilon(0.005));
      }
    }
  }
}

TEST_CASE("the blur agrees with that of the oracle") {
  const int size = 40;
  const ParallelOperator sharp(parts::turn(size, 60));
  const BlurredOperator light(sharp, 1.3, lanes);
  const std::vector<Slab> g{parts::noise(light.sinogram(), 3)};
  auto dose = slabs(1, size, size);
  auto clear = slabs(1, size, size);
  light.adjoint(g, dose);
  sharp.adjoint(g, clear);
  const auto want = images(dose[0]);
  int k = 0;
  light::BlurStream blur(1.3, [&](const vam::Image& slice) {
    for (std::size_t i = 0; i < slice.values.size(); ++i) {
      CHECK(std::abs(slice.values[i] - want[k].values[i]) < 1e-4F);  // of values of order 5, in float
    }
    ++k;
  });
  for (auto& image : images(clear[0])) blur.push(image);
  blur.finish();
  CHECK(k == lanes);
}

TEST_CASE("a part compensated for the blur prints better under it than one that was not") {
  const int size = 96;
  const double sigma_px = 1.2;
  const auto target = vam::oracle::resolution_target(size);
  std::vector<std::vector<float>> block(lanes, target);  // ends included: above and below there is void
  const std::vector<float> empty(target.size(), 0.0F);
  for (const std::size_t end : {0, 1, 2, 13, 14, 15}) block[end] = empty;
  const auto all = parts::stacked(block);
  const auto problem = parts::make_problem(all.data(), lanes, size, size, parts::circle(size), {});
  const ParallelOperator sharp(parts::turn(size, 120));
  const BlurredOperator blurred(sharp, sigma_px, lanes);
  const auto run = [&](const Operator& light) {
    Iterate state;
    run_method(*make_method("apg", {}), problem, light, {.iterations = 40, .until = {}, .patience = 0}, state);
    return judged(sharp, state.g, problem, sigma_px);
  };
  const auto without = run(sharp);
  const auto with = run(blurred);
  MESSAGE("middle slice: PW " << without[8].pw << " -> " << with[8].pw << ", VER " << without[8].ver << " -> "
                              << with[8].ver << "; last slice with part: IoU " << without[12].iou << " -> "
                              << with[12].iou);
  CHECK(with[8].pw > without[8].pw + 0.05);
  CHECK(with[8].ver < 0.5 * without[8].ver);
  CHECK(with[12].iou >= without[12].iou);
}

TEST_CASE("slices that share dose take steps together, so that the doses are those of the projections") {
  const int size = 64;
  const auto wheel = vam::oracle::wheel(size);
  std::vector<std::vector<float>> block(5, wheel);
  block[0] = vam::oracle::resolution_target(size);
  const auto all = parts::stacked(block);
  const auto problem = parts::make_problem(all.data(), 5, size, size, parts::circle(size), {});
  const ParallelOperator sharp(parts::turn(size, 60));
  const BlurredOperator light(sharp, 1, 5);
  for (const std::string name : {"apg", "cal", "pm", "bclp"}) {
    CAPTURE(name);
    Iterate state;
    run_method(*make_method(name, {}), problem, light, {.iterations = 12, .until = {}, .patience = 0}, state);
    auto dose = slabs(1, size, size);
    light.adjoint(state.g, dose);
    for (std::size_t i = 0; i < dose[0].values.size(); ++i) {
      CHECK(std::abs(dose[0].values[i] - state.dose[0].values[i]) < 1e-5F);
    }
  }
}
