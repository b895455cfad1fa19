// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/simulation/simulation.hpp"
#include "oracle/part_2d.hpp"
#include "oracle/ray_tracer.hpp"
#include "oracle/walked_dose.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::light;

namespace {

constexpr double turn_rad = 2 * std::numbers::pi;
constexpr int size = 80;        // voxels across
constexpr double voxel = 0.13;  // mm; the corners are within the reach of the rays, so that no light is folded

using Form = std::function<bool(double, double)>;

// Off the axis, none of them symmetrical.
const Form convex = [](double x, double y) { return std::hypot(x - 6, y + 3) < 9; };
const Form concave = [](double x, double y) {  // a horseshoe, open to one side
  const double r = std::hypot(x - 4, y);
  return r > 9 && r < 14 && (x < 10 || y > 4);
};
const Form ring = [](double x, double y) {
  const double r = std::hypot(x + 5, y - 2);
  return r > 8 && r < 12;
};

model::Printer printer(double absorption_per_mm) {
  return {.projector = {.columns = 400, .pixel_mm = 0.065, .lens_distance_mm = 119.808, .axis_column = 199.5},
          .resin = {.absorption_per_mm = absorption_per_mm},
          .stage = {.motion = "stepped"}};
}

model::StackInfo stack(model::Space space, int columns, double pixel_mm) {
  return {.space = space,
          .width = columns,
          .height = 120,
          .count = 1,
          .pixel_mm = pixel_mm,
          .row_mm = voxel,
          .angle_step_deg = 3};
}

struct Compared {
  double mean = 0;       // of the differences, of a turn in full light
  double most = 0;       // of the differences
  double in_insert = 0;  // most dose there
};

Compared compare(const Image& dose, const std::vector<double>& want, const std::vector<float>& insert) {
  Compared result;
  for (std::size_t p = 0; p < dose.size(); ++p) {
    const double off = std::abs(static_cast<double>(dose.values[p]) - want[p]) / turn_rad;
    result.mean += off / static_cast<double>(dose.size());
    result.most = std::max(result.most, off);
    if (insert[p] >= 0.5F) result.in_insert = std::max(result.in_insert, std::abs(dose.values[p] + 0.0));
  }
  return result;
}

Image image_of(const std::vector<float>& values) {
  Image image(size, size);
  image.values = values;
  return image;
}

Image dose_around(const model::Printer& bench, const model::StackInfo& info, const std::vector<float>& insert) {
  const Simulation simulation(bench, {}, info, model::centred_grid(size, size, 1, voxel), Climb::flat);
  const std::vector<Image> light(1, Image(info.width, info.height, 1.0F));
  const std::vector<Image> inserts(1, image_of(insert));
  std::vector<Image> dose(1);
  simulation.dose(light, dose, inserts);
  return dose[0];
}

vam::oracle::WalkedDose walk(const model::Printer& bench, const std::vector<float>& insert) {
  vam::oracle::WalkedDose slow{.size = size,
                               .voxel = voxel,
                               .edge = model::resin_radius_mm(bench.vial),
                               .absorption = bench.resin.absorption_per_mm};
  for (int a = 0; a < 120; ++a) slow.angles.push_back(bench.stage.direction * a * turn_rad / 120);
  slow.insert = insert;
  return slow;
}

}  // namespace

// A voxel takes the light of two or three rays that pass within a voxel of its middle, the walk that of all its parts.
// They differ where a shadow's edge crosses the voxel. Seen from a distance d the edge takes voxel / d rad to pass:
// next to the insert, d of some voxels, that is up to a twentieth of a turn, in the mean over 80 x 80 voxels a
// thousandth or two.

TEST_CASE("around an insert, convex or concave, parallel light agrees with voxel-by-voxel ray traversal") {
  for (const Form& form : {convex, concave}) {
    const std::vector<float> insert = vam::oracle::draw(size, form);
    const model::Printer bench = printer(0.05);
    const model::StackInfo info = stack(model::Space::virtual_, 120, voxel);
    vam::oracle::WalkedDose slow = walk(printer(0.05), insert);
    for (double& theta : slow.angles) theta = std::abs(theta);  // a virtual stack knows no stage
    const double pitch = voxel / 6;
    for (int k = 0; k < 720; ++k) slow.rays.push_back({(k - 359.5) * pitch, 0, pitch});
    const Compared with = compare(dose_around(bench, info, insert), vam::oracle::walked_dose(slow), insert);
    CHECK(with.mean < 0.003);
    CHECK(with.most < 0.05);
    CHECK(with.in_insert == 0);
  }
}

TEST_CASE("around an insert, convex or concave, the dose of chief rays agrees with voxel-by-voxel ray traversal") {
  for (const Form& form : {convex, concave}) {
    const std::vector<float> insert = vam::oracle::draw(size, form);
    const model::Printer bench = printer(0.05);
    const model::StackInfo info = stack(model::Space::projector, 400, 0.065);
    vam::oracle::WalkedDose slow = walk(bench, insert);
    const optics::View view = optics::projector_view(bench);
    vam::oracle::Bench glass{.lens_distance = view.lens_mm, .bath = view.bath_index, .window = view.window_mm};
    for (const optics::Shell& shell : view.shells) glass.cylinders.push_back({shell.radius_mm, shell.index});
    const double pitch = 0.065 / 4;
    for (int k = 0; k < 1600; ++k) {
      const auto ray = vam::oracle::trace(glass, (k - 799.5) * pitch);
      if (!ray) continue;
      const vam::oracle::Line line = vam::oracle::line_of(*ray);
      slow.rays.push_back(
          {static_cast<double>(line.t), static_cast<double>(line.a), static_cast<double>(ray->transmittance) * pitch});
    }
    const Compared with = compare(dose_around(bench, info, insert), vam::oracle::walked_dose(slow), insert);
    CHECK(with.mean < 0.003);
    CHECK(with.most < 0.05);
    CHECK(with.in_insert == 0);
  }
}

TEST_CASE("a closed ring leaves its inside dark, an empty insert casts no shadow") {
  const std::vector<float> closed = vam::oracle::draw(size, ring);
  for (const model::Space space : {model::Space::virtual_, model::Space::projector}) {
    const bool parallel = space == model::Space::virtual_;
    const model::StackInfo info = stack(space, parallel ? 120 : 400, parallel ? voxel : 0.065);
    const Image dose = dose_around(printer(0), info, closed);
    CHECK(dose(35, 42) == 0);
    CHECK(dose(60, 70) > 1);
    const Image past = dose_around(printer(0), info, std::vector<float>(closed.size(), 0.49F));
    const Simulation simulation(printer(0), {}, info, model::centred_grid(size, size, 1, voxel), Climb::flat);
    const std::vector<Image> light(1, Image(info.width, info.height, 1.0F));
    std::vector<Image> plain(1);
    simulation.dose(light, plain);
    for (std::size_t p = 0; p < past.size(); ++p) {
      CHECK(std::abs(past.values[p] / static_cast<double>(plain[0].values[p]) - 1) <
            1e-5);  // sums of 120 floats in another order
    }
  }
}

TEST_CASE("every slice has the shadow of its own insert, an insert of other voxels is refused") {
  const model::StackInfo info = stack(model::Space::projector, 400, 0.065);
  const model::Grid grid = model::centred_grid(size, size, 1, voxel);
  const Simulation simulation(printer(0), {}, info, grid, Climb::flat);
  std::vector<Image> inserts;
  for (int s = 0; s < 20; ++s) {  // more than are followed together, some alike
    inserts.push_back(image_of(vam::oracle::draw(size, [s](double x, double y) {
      return std::hypot(x - s / 2, y) < 5;  // whole pixels
    })));
  }
  const std::vector<Image> light(20, Image(400, 120, 1.0F));
  std::vector<Image> together(20);
  simulation.dose(light, together, inserts);
  for (const std::size_t s : {0U, 1U, 7U, 15U, 16U, 19U}) {
    std::vector<Image> alone(1);
    simulation.dose({&light[s], 1}, alone, {&inserts[s], 1});
    for (std::size_t p = 0; p < alone[0].size(); ++p) {  // sums of the same terms in another order
      CHECK(alone[0].values[p] == doctest::Approx(together[s].values[p]).epsilon(1e-4));
    }
  }
  inserts[3] = Image(size, size - 1);
  CHECK(fault_of([&] { simulation.dose(light, together, inserts); }) == Fault::data);
}
