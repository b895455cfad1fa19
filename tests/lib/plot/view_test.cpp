// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/view.hpp"

#include <cstdlib>
#include <cstring>
#include <fstream>

#include "io/image/image_file.hpp"
#include "io/vdb/vdb.hpp"
#include "lib/io/scratch.hpp"
#include "plot/private/insert_shadows.hpp"
#include "testing.hpp"

using namespace vam::io;
using namespace vam::plot;
using vam::Image;
using vam::Rgb;

using scratch::slurp;

namespace {

// A value that tells i, j and k apart.
float label(int i, int j, int k) { return static_cast<float>(1 + i + 100 * j + 10000 * k); }

SparseVolume labelled(const std::string& name, const vam::model::Grid& grid) {
  SparseVolume volume(name, grid);
  std::vector<float> slices;
  for (const auto [k, j, i] : indices(grid.nz, grid.ny, grid.nx)) slices.push_back(label(i, j, k));
  volume.write_slices(0, grid.nz, slices.data());
  return volume;
}

// A ball of 3 mm around (1, 0, 0) mm with a soft edge of one voxel.
SparseVolume ball(const vam::model::Grid& grid) {
  SparseVolume volume("target", grid);
  std::vector<float> slices;
  for (const auto [k, j, i] : indices(grid.nz, grid.ny, grid.nx)) {
    const double r_mm = std::hypot(grid.x_mm(i) - 1, grid.y_mm(j), grid.z_mm(k));
    slices.push_back(static_cast<float>(std::clamp(0.5 + (3 - r_mm) / grid.voxel_mm, 0.0, 1.0)));
  }
  volume.write_slices(0, grid.nz, slices.data());
  return volume;
}

void keep(const vam::RgbImage& image, const std::string& name) {
  if (const char* folder = std::getenv("VAM_IMAGES")) write_png(std::string(folder) + "/" + name, image);
}

}  // namespace

TEST_CASE("sections are drawn upright: y up across the axis, z up along it") {
  const auto grid = vam::model::centred_grid(5, 4, 19, 0.5, -2);
  const SparseVolume volume = labelled("dose", grid);
  const auto axial = planes(volume, Plane::axial, {2, 17});
  CHECK(axial[1].width == 5);
  CHECK(axial[1].height == 4);
  CHECK(axial[0](1, 0) == label(1, 3, 2));
  CHECK(axial[1](4, 3) == label(4, 0, 17));
  const auto coronal = planes(volume, Plane::coronal, {1});
  CHECK(coronal[0].height == 19);
  CHECK(coronal[0](3, 0) == label(3, 1, 18));
  CHECK(coronal[0](0, 18) == label(0, 1, 0));
  const auto sagittal = planes(volume, Plane::sagittal, {4});
  CHECK(sagittal[0].width == 4);
  CHECK(sagittal[0](2, 3) == label(4, 2, 15));
  CHECK(plane_index(grid, Plane::axial, -1.1) == 2);
  CHECK(plane_mm(grid, Plane::sagittal, 4) == doctest::Approx(1));
}

TEST_CASE("a contour runs where the value is, closed around a blob") {
  Image image(21, 21);
  for (const auto [y, x] : indices(21, 21)) image(x, y) = static_cast<float>(7 - std::hypot(x - 10, y - 10));
  const auto pieces = contour(image, 0.0F);
  double length = 0;
  for (const auto& piece : pieces) {
    CHECK(std::hypot(piece.from.x - 10, piece.from.y - 10) == doctest::Approx(7).epsilon(0.01));
    length += std::hypot(piece.to.x - piece.from.x, piece.to.y - piece.from.y);
  }
  CHECK(length == doctest::Approx(2 * std::acos(-1.0) * 7).epsilon(0.01));  // chords of about a pixel: h^2 / 24 r^2
}

TEST_CASE("at a saddle the pieces do not cross: the mean decides which corners are cut off") {
  Image image(2, 2);
  image.values = {1, 0, 0, 1};
  const auto joined = contour(image, 0.4F);  // mean 0.5 is inside: the two low corners are cut off
  REQUIRE(joined.size() == 2);
  for (const auto& piece : joined) {
    const double to_low_right = std::hypot(piece.from.x - 1, piece.from.y) + std::hypot(piece.to.x - 1, piece.to.y);
    const double to_low_left = std::hypot(piece.from.x, piece.from.y - 1) + std::hypot(piece.to.x, piece.to.y - 1);
    CHECK(std::min(to_low_right, to_low_left) == doctest::Approx(0.8));  // 0.4 from the corner along both sides
  }
}

TEST_CASE("the target's outline lies on the dose, also when their grids differ") {
  const auto fine = vam::model::centred_grid(60, 60, 40, 0.2, -3.9);
  const SparseVolume target = ball(fine);
  const auto coarse = vam::model::centred_grid(20, 24, 12, 0.5, -2.75);
  for (const Plane plane : {Plane::axial, Plane::coronal, Plane::sagittal}) {
    const auto lines = outlines(target, coarse, plane, {0.25, 40.0});
    CHECK(lines[1].empty());  // beyond the target
    REQUIRE(lines[0].size() > 50);
    const Spot origin = plane_origin_mm(coarse, plane);
    const int rows = plane == Plane::axial ? 24 : 12;
    const double at_mm = plane == Plane::sagittal ? 0.25 - 1 : 0.25;  // section's distance from the middle of the ball
    const double radius = std::sqrt(9 - std::pow(at_mm + 0.0, 2));
    for (const auto& piece : lines[0]) {
      const double right = origin.x + 0.5 * piece.from.x - (plane == Plane::sagittal ? 0 : 1);
      const double up = origin.y + 0.5 * (rows - 1 - piece.from.y);
      CHECK(std::hypot(right, up) == doctest::Approx(radius).epsilon(0.03));  // the section is the nearest of 0.2 mm
    }
  }
}

TEST_CASE("colours are even and have the right ends") {
  CHECK(colour(ColourMap::grey, 0.5) == Rgb{128, 128, 128});
  CHECK(colour(ColourMap::grey, 7) == Rgb{255, 255, 255});
  CHECK(colour(ColourMap::diverging, 0.5) == Rgb{255, 255, 255});
  CHECK(colour(ColourMap::diverging, 0) == Rgb{0, 0, 255});
  CHECK(colour(ColourMap::diverging, 1) == Rgb{255, 0, 0});
  CHECK(colour(ColourMap::viridis, 0) == Rgb{68, 1, 84});  // matplotlib's table, rounded
  CHECK(colour(ColourMap::viridis, 1) == Rgb{253, 231, 37});
  double before = -1;  // viridis rises in lightness all along
  for (int i = 0; i <= 100; ++i) {
    const Rgb c = colour(ColourMap::viridis, i / 100.0);
    const double luma = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    CHECK(luma >= before - 0.5);
    before = luma;
  }
}

TEST_CASE("a figure shows every voxel as a square of its colour, right way up") {
  const auto grid = vam::model::centred_grid(8, 6, 4, 0.5, 0);
  SparseVolume volume("dose", grid);
  std::vector<float> slices(grid.size(), 0.25F);
  slices[2 * grid.slice_size() + 5 * 8 + 7] = 1;  // slice 2, uppermost row, last column
  volume.write_slices(0, grid.nz, slices.data());
  ViewOptions options{.name = "dose.vdb", .at = 1.0};
  const ImageFigure figure = view_volume(volume, nullptr, options);
  CHECK(figure.title == "dose.vdb: dose, axial section at z = 1 mm");
  CHECK(figure.x.low == doctest::Approx(-2));
  CHECK(figure.x.high == doctest::Approx(2));
  CHECK(figure.y.low == doctest::Approx(-1.5));
  CHECK(figure.scale.high == 1);
  const auto image = draw(figure).image();
  keep(image, "voxel.png");
  // 90 pixels a voxel: the bright one is at the upper right.
  const Spot corner = panel_box(figure, 0).first;
  const int left = static_cast<int>(corner.x);
  const int top = static_cast<int>(corner.y);
  CHECK(image(left + 7 * 90 + 45, top + 45) == colour(ColourMap::viridis, 1));
  CHECK(image(left + 6 * 90 + 45, top + 45) == colour(ColourMap::viridis, 0.25));
  CHECK(image(left + 7 * 90 + 45, top + 90 + 45) == colour(ColourMap::viridis, 0.25));
  options.at = 9.0;
  CHECK(has(error_of([&] { (void)view_volume(volume, nullptr, options); }, vam::Fault::data),
            "no axial section at 9 mm; it reaches from 0 mm to 1.5 mm"));
}

TEST_CASE("the histogram counts whole voxels inside, and outside within the circle") {
  const auto grid = vam::model::centred_grid(40, 40, 40, 0.25, -4.875);
  const SparseVolume target = ball(grid);
  SparseVolume dose("dose", grid);
  std::vector<float> covered(grid.size());
  target.read_slices(0, grid.nz, covered.data());
  std::vector<float> doses;
  for (const float c : covered)
    doses.push_back(c > 0.999F ? 0.9F : c < 0.001F ? 0.2F : 5.0F);  // the surface must not count
  dose.write_slices(0, grid.nz, doses.data());
  const vam::model::Circle circle{19.5, 19.5, 18};
  ViewOptions options{.name = "dose.vdb"};
  options.critical = 0.5;
  const Plot plot = dose_histogram(dose, target, circle, options);
  REQUIRE(plot.series.size() == 2);
  CHECK(plot.x.high == doctest::Approx(0.9));
  for (const auto& series : plot.series) {
    double sum = 0;
    double largest = 0;
    for (const double percent : series.y) {
      sum += percent;
      largest = std::max(largest, percent);
    }
    CHECK(sum == doctest::Approx(100));
    CHECK(largest == doctest::Approx(100));
  }
  CHECK(plot.markers[0].words == "minimum inside 0.9");
  CHECK(plot.markers[1].words == "maximum outside 0.2");
  CHECK(plot.markers[2].words == "critical dose 0.5");
  keep(draw(plot).image(), "dose-histogram.png");
  SparseVolume insert("insert", grid);  // it absorbs no dose, and is no void
  std::vector<float> opaque(grid.size(), 0.0F);
  for (std::size_t i = 0; i < opaque.size(); ++i) {
    if (covered[i] < 0.001F && i % 40 == 20) opaque[i] = 1, doses[i] = 3.0F;
  }
  insert.write_slices(0, grid.nz, opaque.data());
  dose.write_slices(0, grid.nz, doses.data());
  const Plot without = dose_histogram(dose, target, circle, options, &insert);
  CHECK(without.x.high == doctest::Approx(0.9));
  CHECK(without.series[0].y == plot.series[0].y);
  CHECK(without.series[0].name == "outside part and insert");
  CHECK(dose_histogram(dose, target, circle, options).x.high == doctest::Approx(3));
  const SparseVolume other("target", vam::model::centred_grid(8, 8, 8, 1, 0));
  CHECK(has(error_of([&] { (void)dose_histogram(dose, other, circle, options); }, vam::Fault::data),
            "has 40 x 40 x 40 voxels of 0.25 mm from (-4.875, -4.875, -4.875), but the other volume has "
            "8 x 8 x 8 voxels of 1 mm from (-3.5, -3.5, 0); compute the dose on this target"));
}

TEST_CASE("two volumes are seen in the same colours, their difference with zero in the middle") {
  const auto grid = vam::model::centred_grid(2, 2, 1, 1.0, 0);
  SparseVolume one("dose", grid);
  SparseVolume two("dose", grid);
  const std::vector<float> first{0, 1, 2, 3};
  const std::vector<float> second{0, 1, 4, 2};
  one.write_slices(0, 1, first.data());
  two.write_slices(0, 1, second.data());
  const ImageFigure figure = view_difference(one, {{&two, "b.vdb"}}, nullptr, {});
  REQUIRE(figure.panels.size() == 3);
  CHECK(figure.panels[2].values.values == std::vector<float>{2, -1, 0, 0});  // the upper row first
  CHECK(figure.panels[0].scale->high == 4);
  CHECK(figure.panels[1].scale->high == 4);
  CHECK(figure.panels[2].scale->low == -2);
  CHECK(figure.panels[2].scale->high == 2);
  const SparseVolume moved("dose", vam::model::centred_grid(2, 2, 1, 1.0, 0.5));
  const SparseVolume finer("dose", vam::model::centred_grid(2, 2, 1, 0.5, 0));
  for (const SparseVolume* other : {&moved, &finer}) {
    CHECK(has(error_of(
                  [&] {
                    (void)view_difference(one, {{other, "b.vdb"}}, nullptr, {});
                  },
                  vam::Fault::data),
              "compare volumes of one grid"));
  }
}

TEST_CASE("of several volumes each stands beside the first, with the outline of a target, cropped to it") {
  const auto grid = vam::model::centred_grid(40, 30, 1, 1.0, 0);
  SparseVolume one("dose", grid);
  SparseVolume two("dose", grid);
  SparseVolume target("target", grid);
  std::vector<float> part(40 * 30), dose(40 * 30, 1);
  for (const int j : {20, 21, 22})
    for (const int i : {10, 11, 12, 13}) part[static_cast<std::size_t>(j) * 40 + i] = 1;
  target.write_slices(0, 1, part.data());
  one.write_slices(0, 1, part.data());
  two.write_slices(0, 1, dose.data());
  ImageFigure figure = view_difference(one, {{&two, "b"}, {&one, "c"}}, &target, {});
  REQUIRE(figure.panels.size() == 5);
  CHECK(figure.panels[3].caption == "b minus first");
  const std::size_t pieces = figure.panels[4].outline.size();
  CHECK(pieces > 8);
  crop_to_part(figure, target, vam::plot::Plane::axial);
  CHECK(figure.panels[0].values.width == 4 + 2 * 2);
  CHECK(figure.panels[2].values.height == 3 + 2 * 2);
  CHECK(figure.panels[0].values(2, 2) == 1);  // the part begins behind a margin of 2
  CHECK(figure.panels[0].values(1, 2) == 0);
  CHECK(figure.panels[4].outline.size() == pieces);
  CHECK(figure.x.low == doctest::Approx(-20 + 10 - 2));
  CHECK(figure.y.low == doctest::Approx(-15 + 20 - 2));
  CHECK(figure.y.high == doctest::Approx(-15 + 23 + 2));
}

TEST_CASE("a section far wider than high is drawn, a pixel high") {
  const auto grid = vam::model::centred_grid(1500, 3, 1, 0.1, 0);
  SparseVolume volume("dose", grid);
  const std::vector<float> slice(grid.size(), 1.0F);
  volume.write_slices(0, 1, slice.data());
  const auto image = draw(view_volume(volume, nullptr, ViewOptions{.plane = Plane::coronal})).image();
  CHECK(std::count(image.values.begin(), image.values.end(), paint::black) > 700);
}

TEST_CASE("colours end where one value in a thousand is beyond, which the legend says") {
  const auto grid = vam::model::centred_grid(100, 100, 1, 1.0, 0);
  SparseVolume dose("dose", grid);
  std::vector<float> values(grid.size(), 1.0F);
  for (std::size_t i = 0; i < 5; ++i) values[i] = 50;  // 0.05 %
  dose.write_slices(0, 1, values.data());
  const ImageFigure figure = view_volume(dose, nullptr, {});
  CHECK(figure.scale.high == 1);
  REQUIRE(figure.legend.size() == 1);
  CHECK(figure.legend[0].words == "0.05 % of the pixels are above 1 (to 50)");
}

TEST_CASE("NRRD has the dense box behind a header that gives its position") {
  const scratch::Folder folder;
  const auto grid = vam::model::centred_grid(5, 4, 19, 0.5, -2);
  SparseVolume volume = labelled("dose", grid);
  volume.history = {"vam-test 1"};
  write_nrrd(folder / "a.nrrd", volume);
  const std::string bytes = slurp(folder / "a.nrrd");
  const std::size_t body = bytes.find("\n\n") + 2;
  CHECK(bytes.size() == body + 4 * grid.size());
  CHECK(has(bytes, "# vam-test 1\n"));
  CHECK(has(bytes, "sizes: 5 4 19\n"));
  CHECK(has(bytes, "space directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)\nspace origin: (-1,-0.75,-2)\n"));
  float value = 0;
  std::memcpy(&value, bytes.data() + body + 4 * ((17 * 4 + 2) * 5 + 3), sizeof value);
  CHECK(value == label(3, 2, 17));
}

TEST_CASE("NRRD keeps a line break in a name, unit or history out of its header") {
  const scratch::Folder folder;
  SparseVolume volume("dose\nsizes: 9 9 9", vam::model::centred_grid(5, 4, 3, 0.5, 0));
  volume.units = "mJ\n\nspace: left";
  volume.history = {"vam-test 1\nendian: big"};
  write_nrrd(folder / "a.nrrd", volume);
  const std::string bytes = slurp(folder / "a.nrrd");
  CHECK(has(bytes, "\n# vam-test 1\\nendian: big\n"));
  CHECK(has(bytes, "\ncontent: dose\\nsizes: 9 9 9 (mJ\\n\\nspace: left)\nspace: 3D-right-handed\n"));
}

TEST_CASE("file types are determined by content") {
  const scratch::Folder folder;
  const auto written = [&](const std::string& bytes) {
    std::ofstream(folder / "f", std::ios::binary) << bytes;
    return (folder / "f");
  };
  SparseVolume volume = labelled("dose", vam::model::centred_grid(5, 4, 3, 0.5));
  write_volume(folder / "v", volume);
  CHECK(file_type(folder / "v") == FileType::volume);
  CHECK(file_type(written("\x76\x2f\x31\x01....")) == FileType::stack);
  CHECK(file_type(written("\x1a\x45\xdf\xa3....")) == FileType::video);
  CHECK(file_type(written(std::string("\0\0\0\x20"
                                      "ftypisom",
                                      12))) == FileType::video);
  CHECK(file_type(folder.path.string()) == FileType::images);
  CHECK(has(error_of([&] { (void)file_type(written("solid part")); }, vam::Fault::data), "neither a volume (VDB)"));
  CHECK(has(error_of([&] { (void)file_type(written("")); }, vam::Fault::data), "is empty"));
}

TEST_CASE("an insert is hatched, and hides what is behind it from the angles that its width subtends") {
  const vam::model::Grid grid = vam::model::centred_grid(81, 81, 3, 0.1);
  SparseVolume insert("insert", grid);
  std::vector<float> slices(grid.size(), 0.0F);
  for (const auto [j, i] : indices(81, 81)) {
    if (std::hypot(i - 40, j - 40) <= 8) slices[81 * 81 + static_cast<std::size_t>(j) * 81 + i] = 1;
  }
  insert.write_slices(0, 3, slices.data());
  const auto axial = insert_shadows(insert, Plane::axial, {0, 1});
  CHECK(axial[0](60, 40) == 0);  // the insert is in the slice above
  CHECK(planes(insert, Plane::axial, {1})[0](40, 40) == 1);
  CHECK(axial[1](40, 40) == 0);
  for (const int far : {14, 20, 32}) {  // sampled every 7.5 degrees, the rim rough by half a voxel of `far`
    const double want = std::asin(8.0 / far) / std::numbers::pi;
    CHECK(std::abs(static_cast<double>(axial[1](40 + far, 40)) - want) < 1.0 / 48 + 0.5 / far / std::numbers::pi);
    CHECK(std::abs(axial[1](40, 40 - far) - axial[1](40 + far, 40)) < 0.03F);
  }
  const auto upright = insert_shadows(insert, Plane::coronal, {40});
  CHECK(upright[0](60, 1) == axial[1](60, 40));
  CHECK(upright[0](60, 0) == 0);

  SparseVolume target = ball(grid);
  const ImageFigure figure = view_volume(target, nullptr, {}, &insert);
  CHECK(figure.panels[0].hatched(40, 40) == 1);
  CHECK(figure.hatched_name == "insert");
  REQUIRE(figure.legend.size() == 1);
  CHECK(figure.legend[0].mark == Mark::patch);
  CHECK(figure.legend[0].words.starts_with("its shadow"));
  keep(draw(figure).image(), "insert.png");
}
