// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of [RAY21] as numbers: what each missing correction does to the dose of a disc grid (period 35 px, radius
// 8 px, n = 1.53, throw ratio 1.8, 1024 columns, vial radius 212.37 px). Everything in pixels.
#include "lib/light/vial_dose.hpp"
#include "optics/resample.hpp"
#include "testing.hpp"
#include "tomo/fbp.hpp"

using namespace vam;
using namespace vam::optics;
using namespace vam::light;

namespace {

constexpr int angles = 360;
constexpr double lens = 1.8 * 1024;
constexpr double radius = 212.37;
const View printer{lens, 1.0, 0.0, {{radius, 1.53}}};
const Detector projector = centred_detector(1024, 1);
const Turn turn{angles, 0, 2 * std::numbers::pi / angles};

// Coverage of pixels by the discs of the grid that lie within `reach`, from 8 x 8 points each.
Image disc_grid(const model::Grid& grid, double reach) {
  Image image(grid.nx, grid.ny);
  for (const auto [j, i, k] : indices(grid.ny, grid.nx, 64)) {
    const double x = grid.x_mm(i + (k % 8 - 3.5) / 8);
    const double y = grid.y_mm(j + (k / 8 - 3.5) / 8);
    const double cx = 35 * std::round(x / 35);
    const double cy = 35 * std::round(y / 35);
    if (std::hypot(cx, cy) + 8 < reach && std::hypot(x - cx, y - cy) < 8) image(i, j) += 1.0F / 64;
  }
  return image;
}

// Ramp-filtered projections without their negative part: the recipe of the paper.
Image filtered(const model::Grid& grid, const Image& target, int& columns) {
  const tomo::ParallelGeometry geometry = tomo::full_turn(grid, angles);
  Slab object(grid.nx, grid.ny);
  pack(target.values.data(), 1, object);
  std::vector<Slab> sinograms(1, Slab(geometry.columns, angles));
  tomo::forward(geometry, {&object, 1}, sinograms);
  tomo::Filter(geometry.columns, {}).apply(sinograms.front());
  columns = geometry.columns;
  Image image(columns, angles);
  unpack(sinograms.front(), 1, image.values.data());
  for (float& value : image.values) value = std::max(value, 0.0F);
  return image;
}

struct Case {
  model::Grid grid;
  Image target;
  Image sinogram;
};

Case make_case(int n) {
  Case c;
  c.grid = model::centred_grid(n, n, 1, 1);
  c.target = disc_grid(c.grid, 0.5 * n);
  int columns = 0;
  c.sinogram = filtered(c.grid, c.target, columns);
  return c;
}

// What the machine prints when its light was corrected as if it were `assumed`.
Image printed(const Case& c, const View& machine, const View& assumed,
              Interpolation interpolation = Interpolation::cubic, bool keep_negative = false) {
  ResampleOptions options{.interpolation = interpolation, .keep_negative = keep_negative};
  std::vector<Image> light(1);
  resample(plan_to_projector(assumed, centred_detector(c.sinogram.width, 1), projector, turn, options),
           {&c.sinogram, 1}, light);
  VialSetup setup{.view = machine, .projector = projector, .turn = turn, .grid = c.grid};
  return parts::dose_of(setup, light.front());
}

// Best |print and part| / |print or part| over all thresholds, of the pixels between two radii.
struct Threshold {
  double iou = 0;
  float dose = 0;
};
double iou_at(const Case& c, const Image& dose, float threshold, double low, double high) {
  double both = 0;
  double either = 0;
  for (const auto [j, i] : indices(c.grid.ny, c.grid.nx)) {
    const double r = std::hypot(c.grid.x_mm(i), c.grid.y_mm(j));
    if (r < low || r >= high) continue;
    const bool print = dose(i, j) >= threshold;
    const bool part = c.target(i, j) >= 0.5F;
    both += print && part ? 1 : 0;
    either += print || part ? 1 : 0;
  }
  return both / either;
}
Threshold best(const Case& c, const Image& dose) {
  Threshold result;
  const float top = *std::max_element(dose.values.begin(), dose.values.end());
  for (int k = 1; k < 400; ++k) {
    const float threshold = top * static_cast<float>(k) / 400;
    const double iou = iou_at(c, dose, threshold, 0, 0.5 * c.grid.nx);
    if (iou > result.iou) result = {iou, threshold};
  }
  return result;
}

struct Result {
  double all, centre, edge;
};
Result judge(const Case& c, const View& machine, const View& assumed) {
  const Image dose = printed(c, machine, assumed);
  const Threshold t = best(c, dose);
  const double half = 0.5 * c.grid.nx;
  return {t.iou, iou_at(c, dose, t.dose, 0, 0.3 * half), iou_at(c, dose, t.dose, 0.6 * half, half)};
}

}  // namespace

TEST_CASE("[RAY21] fig 7 and 11: every correction that is left out shows away from the centre") {
  const Case c = make_case(276);  // the writable circle, 2 * 212.37 / 1.53 = 277.6
  const View telecentric{std::nullopt, 1.0, 0.0, {{radius, 1.53}}};
  const View no_lensing{lens, 1.0, 0.0, {{radius, 1.0}}};
  const Result full = judge(c, printer, printer);
  const Result no_divergence = judge(c, printer, telecentric);  // fig 7b
  const Result no_lens = judge(c, printer, no_lensing);         // fig 11b
  MESSAGE("full ", full.all, " ", full.centre, " ", full.edge, "; no divergence ", no_divergence.all, " ",
          no_divergence.centre, " ", no_divergence.edge, "; no lensing ", no_lens.all, " ", no_lens.centre, " ",
          no_lens.edge);
  CHECK(full.all >= 0.95);
  CHECK(full.edge >= 0.95);
  CHECK(no_divergence.centre > 0.88);  // the axis does not care
  CHECK(no_divergence.edge < full.edge - 0.1);
  CHECK(no_lens.all < 0.5);
  CHECK(no_lens.edge < 0.3);
}

TEST_CASE("[RAY21] fig 10: divergence matters in an index-matched bath too") {
  const Case c = make_case(276);
  const View bath{lens, 1.53, 1.2 * radius, {{radius, 1.53}}};
  const View telecentric{std::nullopt, 1.53, 0.0, {{radius, 1.53}}};
  const Result full = judge(c, bath, bath);
  const Result without = judge(c, bath, telecentric);
  MESSAGE("full ", full.all, " ", full.centre, " ", full.edge, "; without ", without.all, " ", without.centre, " ",
          without.edge);
  CHECK(full.all >= 0.95);
  CHECK(without.centre > without.edge + 0.2);
  CHECK(without.edge < full.edge - 0.1);
}

TEST_CASE("cubic resampling measures better than linear: nearer to the ideal parallel dose, and a better print") {
  const Case c = make_case(276);
  const tomo::ParallelGeometry geometry = tomo::full_turn(c.grid, angles);
  Slab light(geometry.columns, angles);
  pack(c.sinogram.values.data(), 1, light);
  Slab ideal(c.grid.nx, c.grid.ny);
  tomo::adjoint(geometry, {&light, 1}, {&ideal, 1});
  const auto error = [&](Interpolation interpolation) {
    const Image dose = printed(c, printer, printer, interpolation, true);
    double square = 0;
    double norm = 0;
    for (std::size_t i = 0; i < dose.size(); ++i) {
      const double want = turn.step_rad * ideal.values[i * lanes];
      square += (dose.values[i] - want) * (dose.values[i] - want);
      norm += want * want;
    }
    return std::sqrt(square / norm);
  };
  const auto iou = [&](Interpolation interpolation) {
    return best(c, printed(c, printer, printer, interpolation)).iou;
  };
  const double linear = error(Interpolation::linear);
  const double cubic = error(Interpolation::cubic);
  const double linear_iou = iou(Interpolation::linear);
  const double cubic_iou = iou(Interpolation::cubic);
  MESSAGE("dose error: linear ", linear, ", cubic ", cubic, "; IoU: ", linear_iou, ", ", cubic_iou);
  CHECK(cubic < 0.9 * linear);
  CHECK(cubic_iou > linear_iou);
}
