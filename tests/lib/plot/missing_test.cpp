// SPDX-License-Identifier: GPL-3.0-or-later
// What of a part is missing: across the limit of the slabs that are read at a time, and where nothing is.
#include "plot/missing.hpp"

#include <numeric>

#include "testing.hpp"

using namespace vam::io;
using namespace vam::plot;

namespace {

constexpr int width = 5;
constexpr int height = 3;
constexpr int depth = 33;  // two slabs of 16 slices and one more

/// A post along z in the middle of void, by slices of coverage and dose.
struct Post {
  std::vector<float> covered = std::vector<float>(depth, 0.0F);
  std::vector<float> doses = std::vector<float>(depth, 1.0F);

  [[nodiscard]] static SparseVolume volume(const std::string& name, const std::vector<float>& of_slice) {
    SparseVolume volume(name, vam::model::centred_grid(width, height, depth, 1.0, 0));
    std::vector<float> values(volume.grid().size(), 0.0F);
    for (int k = 0; k < depth; ++k) values[(k * height + 1) * width + 3] = of_slice[k];
    volume.write_slices(0, depth, values.data());
    return volume;
  }
  [[nodiscard]] SparseVolume target() const { return volume("target", covered); }
  [[nodiscard]] SparseVolume dose() const { return volume("dose", doses); }
  [[nodiscard]] MissingPart missing() const { return missing_part(dose(), target(), 0.5); }
  void set(int first, int end, float coverage, float dose) {
    for (int k = first; k < end; ++k) {
      covered[k] = coverage;
      doses[k] = dose;
    }
  }
};

/// Of the voxels of the post.
std::vector<float> along_post(const SparseVolume& volume) {
  std::vector<float> values(volume.grid().size());
  volume.read_slices(0, depth, values.data());
  std::vector<float> post;
  for (int k = 0; k < depth; ++k) post.push_back(values[(k * height + 1) * width + 3]);
  CHECK(std::accumulate(values.begin(), values.end(), 0.0) ==
        doctest::Approx(std::accumulate(post.begin(), post.end(), 0.0)));
  return post;
}

/// `value` in slices [first, end), else 0.
std::vector<float> only(int first, int end, float value) {
  std::vector<float> slices(depth, 0.0F);
  for (int k = first; k < end; ++k) slices[k] = value;
  return slices;
}

}  // namespace

TEST_CASE("a cut of a post is missing where it is, also beside the limit of two slabs") {
  for (const int k : {14, 15, 16, 17, 31, 32}) {
    CAPTURE(k);
    Post post;
    post.set(0, depth, 0.75F, 1);
    post.set(k, k + 1, 0.75F, 0.2F);
    const MissingPart missing = post.missing();
    // At the end of a post nothing is cut off; a voxel that the surface cuts may stay out of the print there.
    const int end = k == depth - 1 ? k : k + 1;
    CHECK(along_post(missing.shares) == only(k, end, 0.75F));
    CHECK(missing.along[2][k] == (k == depth - 1 ? 0 : 0.75));
    if (k == depth - 1) continue;
    CHECK(missing.along[0] == std::vector<double>{0, 0, 0, 0.75, 0});
    CHECK(missing.along[1] == std::vector<double>{0, 0.75, 0});
    CHECK(missing.section(Plane::axial) == k);
    CHECK(missing.section(Plane::sagittal) == 3);
    CHECK(missing.section(Plane::coronal) == 1);
  }
}

TEST_CASE("a wall is lost by what lies in the next slab, too") {
  for (const int k : {14, 15, 16, 17}) {
    CAPTURE(k);
    Post post;
    post.set(k, k + 1, 0.25F, 0);
    CHECK(along_post(lost_wall_volume(post.target(), nullptr, 0)) == only(k, k + 1, 1));
    CHECK(along_post(post.missing().shares) == only(k, k + 1, 0.25F));
    for (const int beside : {k - 1, k + 1}) {  // half covered: the wall's voxel is of its edge
      CAPTURE(beside);
      Post edge = post;
      edge.set(beside, beside + 1, 0.75F, 1);
      CHECK(along_post(lost_wall_volume(edge.target(), nullptr, 0)) == only(0, 0, 0));
      CHECK(along_post(edge.missing().shares) == only(0, 0, 0));
    }
    Post farther = post;
    farther.set(k + 2, k + 3, 0.75F, 1);
    CHECK(along_post(lost_wall_volume(farther.target(), nullptr, 0)) == only(k, k + 1, 1));
    post.set(k, k + 1, 0.25F, 0.5F);  // cures all the same
    const SparseVolume dose = post.dose();
    CHECK(along_post(lost_wall_volume(post.target(), &dose, 0.5)) == only(0, 0, 0));
    CHECK(along_post(lost_wall_volume(post.target(), &dose, 0.6)) == only(k, k + 1, 1));
  }
}

TEST_CASE("where nothing is missing the section is the middle one") {
  Post post;
  post.set(2, depth - 2, 1, 1);
  const MissingPart nothing = post.missing();
  CHECK(along_post(nothing.shares) == only(0, 0, 0));
  CHECK(nothing.section(Plane::axial) == depth / 2);
  CHECK(nothing.section(Plane::coronal) == height / 2);
  CHECK(nothing.section(Plane::sagittal) == width / 2);
}

TEST_CASE("the section is the one nearest to the middle with half as much missing as in any") {
  Post post;
  post.set(4, 28, 1, 1);
  post.set(5, 6, 1, 0);
  CHECK(post.missing().section(Plane::axial) == 5);
  MissingPart some = post.missing();
  some.along[2] = std::vector<double>(depth, 0.0);
  some.along[2][3] = 4;
  some.along[2][20] = 2;
  some.along[2][15] = 1.9;
  CHECK(some.section(Plane::axial) == 20);
}
