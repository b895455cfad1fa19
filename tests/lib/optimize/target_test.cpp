// SPDX-License-Identifier: GPL-3.0-or-later
// What is asked of slices: checks at the door, thin slices, weights, inserts.
#include <utility>

#include "lib/optimize/parts.hpp"
#include "optimize/target/exclusions.hpp"
#include "optimize/target/slice_reader.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;

namespace {

constexpr int size = 9;
constexpr int pixels = size * size;
const Circle around{4, 4, 3};

// 20 slices of 9 x 9 voxels: three voxels of part in slice 18, void else.
struct Volume {
  std::vector<float> target = std::vector<float>(20 * pixels, 0.0F);
  std::vector<float> insert, weight, tolerance;
  Volume() {
    for (const int x : {3, 4, 7}) at(target, 18, x, 4) = 1;
  }
  static float& at(std::vector<float>& values, int slice, int x, int y) {
    return values[slice * pixels + y * size + x];
  }
  [[nodiscard]] std::vector<SliceDigest> checked(bool grey = false) const {
    const auto reads = [](const std::vector<float>& values) -> VolumeSource::Read {
      if (values.empty()) return {};
      return [&values](int k, int count, float* out) { std::copy_n(values.data() + k * pixels, count * pixels, out); };
    };
    return check({20, reads(target), reads(insert), reads(weight), reads(tolerance), 0}, {size, size}, around, grey);
  }
  [[nodiscard]] std::string refusal() const {
    return error_of([&] { (void)checked(); }, Fault::data);
  }
};

Problem problem_of(const std::vector<float>& slices, int count, const Demands& demands = {}, bool stacked = false,
                   const std::vector<float>& weight = {}) {
  return parts::make_problem(slices.data(), count, size, 1, {4, 0, 4}, demands,
                             weight.empty() ? nullptr : weight.data(), nullptr, stacked);
}

std::vector<float> values_of(const Problem& problem, int slice) {
  std::vector<float> values;
  for (int x = 0; x < size; ++x) values.push_back(problem.target[slice / lanes].at(x, 0)[slice % lanes]);
  return values;
}

// One letter a voxel: part, void, surface, outside.
std::string labels_of(const Problem& problem, int slice) {
  std::string text;
  for (int x = 0; x < size; ++x) {
    const Label label = problem.labels[slice / lanes][x * lanes + slice % lanes];
    text += label == Label::part ? 'p' : label == Label::void_ ? 'v' : label == Label::surface ? 's' : 'o';
  }
  return text;
}

}  // namespace

TEST_CASE("a target is refused with its slice: out of reach, shared with an insert, negative weights") {
  Volume volume;
  CHECK(volume.checked().size() == 20);          // the third voxel is at the radius
  Volume::at(volume.target, 18, 8, 4) = 0.001F;  // rounding
  CHECK(volume.checked().size() == 20);
  Volume::at(volume.target, 18, 8, 4) = 0.002F;
  CHECK(has(volume.refusal(), "slice 18: the part reaches 4 voxels from the axis, but light reaches only 3;"));

  volume = {};
  volume.insert.assign(volume.target.size(), 0);
  Volume::at(volume.target, 17, 4, 4) = 0.5F;
  Volume::at(volume.insert, 17, 4, 4) = 0.54F;
  CHECK(volume.checked().size() == 20);
  Volume::at(volume.insert, 17, 4, 4) = 0.56F;
  CHECK(has(volume.refusal(), "slice 17: part and insert share 1 voxels"));

  volume = {};
  volume.weight.assign(volume.target.size(), 0);
  CHECK(volume.checked().size() == 20);
  Volume::at(volume.weight, 3, 0, 8) = -0.25F;
  CHECK(has(volume.refusal(), "slice 3: a weight, tolerance or delivered dose is -0.25;"));
  volume = {};
  volume.tolerance.assign(volume.target.size(), 0.1F);
  Volume::at(volume.tolerance, 19, 8, 8) = -0.5F;
  CHECK(has(volume.refusal(), "slice 19: a weight, tolerance or delivered dose is -0.5;"));
}

TEST_CASE("a target without part or void is refused, of doses one without part alone") {
  Volume volume;
  volume.target.assign(volume.target.size(), 0.001F);
  CHECK(has(volume.refusal(), "the target is empty"));
  for (const auto [k, y, x] : indices(20, size, size))
    Volume::at(volume.target, k, x, y) = around.contains(x, y) ? 1.0F : 0.0F;
  CHECK(has(volume.refusal(), "fills the whole writable circle"));
  CHECK(volume.checked(true).size() == 20);
  Volume::at(volume.target, 7, 4, 7) = 0.001F;
  CHECK(volume.checked().size() == 20);
}

TEST_CASE("slices are alike where all that they hold is") {
  Volume volume;
  CHECK(volume.checked()[0] == volume.checked()[19]);
  CHECK(volume.checked()[0] != volume.checked()[18]);
  for (auto field : {&Volume::insert, &Volume::weight, &Volume::tolerance}) {
    Volume other;
    (other.*field).assign(other.target.size(), 0);
    Volume::at(other.*field, 19, 1, 1) = 0.5F;
    const auto digests = other.checked();
    CHECK(digests[0] == digests[1]);
    CHECK(digests[0] != digests[19]);
  }
}

TEST_CASE("a thin slice is scaled to a whole one where it is half covered, and stays dark where it is not") {
  const std::vector<float> slices{0, 0.1F, 0.31F, 0.5F, 0.6F, 0, 0.29F, 0.2F,  0,   // the largest is 0.6
                                  0, 0.1F, 0.3F,  0.4F, 0.4F, 0, 0.3F,  0.2F,  0,   // none is half covered
                                  0, 0.1F, 0.3F,  0.5F, 1.0F, 0, 0.3F,  0.25F, 0};  // whole
  const Problem problem = problem_of(slices, 3);
  CHECK(labels_of(problem, 0) == "vspppvssv");  // 0.31 / 0.6 is above a half, 0.29 / 0.6 below
  CHECK(labels_of(problem, 1) == "vssssvssv");
  CHECK(labels_of(problem, 2) == "vssspvssv");
  CHECK(problem.gain[0] == doctest::Approx(1 / 0.6));
  CHECK(problem.gain[1] == 0);
  CHECK(problem.gain[2] == 1);
  CHECK(problem.is_thin(0, 0));
  CHECK_FALSE(problem.is_thin(0, 2));
  CHECK(values_of(problem, 0)[3] == doctest::Approx(0.5 / 0.6));
  CHECK(values_of(problem, 1) == std::vector<float>(9, 0.0F));
  CHECK(values_of(problem, 2)[3] == 0.5F);
}

TEST_CASE("in a stack the slice beside a whole one is where the part ends") {
  const std::vector<float> thin{0, 0.1F, 0.3F, 0.5F, 0.6F, 0, 0.3F, 0.2F, 0};
  const std::vector<float> whole{0, 0.1F, 0.3F, 0.5F, 1.0F, 0, 0.3F, 0.2F, 0};
  const std::vector<float> slices = parts::stacked({thin, thin, whole, thin, thin});
  const Problem problem = problem_of(slices, 5, {}, true);
  const std::vector<float> gains{1 / 0.6F, 1, 1, 1, 1 / 0.6F};
  for (int k = 0; k < 5; ++k) CHECK(problem.gain[k] == doctest::Approx(static_cast<double>(gains[k])));
  const Problem unasked = problem_of(slices, 5, Demands{.free_surface = true}, true);
  CHECK(unasked.gain[1] == doctest::Approx(1 / 0.6));
  CHECK(unasked.gain[3] == doctest::Approx(1 / 0.6));
}

TEST_CASE("weights are parts of the largest of a slice; without one a voxel is unconstrained") {
  const std::vector<float> slice{0, 0, 0.5F, 1, 1, 1, 0.5F, 0, 0};
  const std::vector<float> weight{2, 0, 9, 4, 1, 0, 3, 1, 1};  // that of surface voxels is not the largest
  const Problem problem = problem_of(slice, 1, {}, false, weight);
  CHECK(labels_of(problem, 0) == "vssppssvv");
  for (const auto& [x, part] : {std::pair(0, 0.5F), {3, 1.0F}, {4, 0.25F}, {7, 0.25F}}) {
    CHECK(problem.weight[0].at(x, 0)[0] == part);
  }
}

TEST_CASE("voxels of an insert are outside, the void rule is for void alone") {
  Problem problem = problem_of({0, 0, 0.5F, 1, 1, 1, 0.5F, 0, 0}, 1);
  std::vector<Slab> insert = slabs(1, size, 1);
  for (const int x : {0, 3, 4}) insert[0].at(x, 0)[0] = x == 4 ? 0.1F : 1.0F;
  exclude(problem, insert);
  CHECK(labels_of(problem, 0) == "ovsoppsvv");
  CHECK(values_of(problem, 0)[3] == 0);
  CHECK(values_of(problem, 0)[4] == 1);

  const auto target = [](int, int, float* out) {
    for (const float v : {0.0F, 0.001F, 0.002F, 1.0F}) *out++ = v;
  };
  const auto values = [](int, int, float* out) { std::fill_n(out, 4, 3.0F); };
  const auto twice = [](float& v) { v *= 2; };
  std::vector<float> out(4);
  with_void(target, values, 7, 4, twice)(0, 1, out.data());
  CHECK(out == std::vector<float>{6, 6, 3, 3});
  with_void(target, {}, 7, 4, twice)(0, 1, out.data());
  CHECK(out == std::vector<float>{14, 14, 7, 7});
}
