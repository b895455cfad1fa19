// SPDX-License-Identifier: GPL-3.0-or-later
// What cures, is missing or too much, in a picture.
#include <tuple>

#include "plot/view.hpp"
#include "testing.hpp"

using namespace vam::io;
using namespace vam::plot;
using vam::Rgb;

TEST_CASE("the cure map tells what is missing and what is too much, and where the surface cuts") {
  const auto grid = vam::model::centred_grid(5, 1, 1, 1.0, 0);
  SparseVolume target("target", grid);
  const std::vector<float> covered{1, 1, 0.5F, 0, 0};
  const Rgb cut_missing{150, 200, 235};
  const Rgb cut_cured{245, 190, 140};
  target.write_slices(0, 1, covered.data());
  SparseVolume dose("dose", grid);
  const std::vector<float> doses{0.4F, 1, 0.2F, 0.6F, 0.1F};
  dose.write_slices(0, 1, doses.data());
  const vam::model::Circle all{2, 0, 2};
  const ImageFigure figure = view_cure(dose, target, 0.5, all, {});
  const auto& seen = figure.panels[0].picture.values;
  CHECK(seen == std::vector<Rgb>{paint::blue, {150, 150, 150}, cut_missing, paint::vermilion, paint::white});
  CHECK(figure.legend[1].words == "missing (40 % of the part seen)");  // 1 of 2.5 voxels
  CHECK(figure.legend[2].words == "overcured (50 % of the void seen)");
  CHECK(figure.legend[3].words == "missing in voxels that the surface cuts (20 % of the part seen)");
  for (const auto& [coverage, dose_there, colour] :
       {std::tuple{0.4F, 0.6F, cut_cured}, {0.4F, 0.4F, paint::white}, {0.6F, 0.6F, Rgb{150, 150, 150}}}) {
    std::vector<float> cut = covered;
    std::vector<float> there = doses;
    cut[2] = coverage;
    there[2] = dose_there;
    SparseVolume target2("target", grid), dose2("dose", grid);
    target2.write_slices(0, 1, cut.data());
    dose2.write_slices(0, 1, there.data());
    const ImageFigure cut_figure = view_cure(dose2, target2, 0.5, all, {});
    CHECK(cut_figure.panels[0].picture(2, 0) == colour);
    CHECK(cut_figure.legend.size() == (colour == cut_cured ? 5 : 4));  // what is not seen is not named
    if (colour == cut_cured) CHECK(cut_figure.legend[3].words.starts_with("overcured in voxels that the surface cuts"));
  }
  // Void outside the circle is seen, but not judged.
  const vam::model::Circle inner{2, 0, 1};
  const ImageFigure judged = view_cure(dose, target, 0.5, inner, {});
  CHECK(judged.panels[0].picture.values == seen);
  CHECK(judged.legend[1].words == "missing (40 % of the part seen)");
  CHECK(judged.legend[2].words == "overcured (100 % of the void seen)");
  for (const Plane plane : {Plane::coronal, Plane::sagittal}) {
    ViewOptions along{.plane = plane};
    along.at = plane == Plane::coronal ? 0.0 : 1.0;  // the column of 0.6, in the circle
    CHECK(view_cure(dose, target, 0.5, inner, along).legend[2].words == "overcured (100 % of the void seen)");
  }
}

TEST_CASE("the cure map shows walls that no voxel is half covered by, and where walls are cut") {
  const auto grid = vam::model::centred_grid(3, 3, 9, 1.0, 0);
  std::vector<float> covered(grid.size(), 0.0F);
  std::vector<float> doses(grid.size(), 0.2F);
  const auto set = [&](int k, float coverage, float value) {
    covered[static_cast<std::size_t>(9 * k + 4)] = coverage;
    doses[static_cast<std::size_t>(9 * k + 4)] = value;
  };
  for (const int k : {0, 1, 2, 3, 4}) set(k, 0.6F, 1);
  set(2, 0.6F, 0.4F);                              // cuts the pillar
  for (const int k : {7, 8}) set(k, 0.25F, 0.4F);  // stands free of it
  SparseVolume target("target", grid), dose("dose", grid);
  target.write_slices(0, grid.nz, covered.data());
  dose.write_slices(0, grid.nz, doses.data());
  const vam::model::Circle all{1, 1, 2};
  ViewOptions along{.plane = Plane::coronal};
  const ImageFigure figure = view_cure(dose, target, 0.5, all, along);
  const auto& seen = figure.panels[0].picture;
  for (const int k : {2, 7, 8}) CHECK(seen(1, 8 - k) == paint::blue);
  CHECK(seen(1, 8 - 1) == Rgb{150, 150, 150});
  CHECK(figure.legend[1].words == "missing (31.4 % of the part seen)");  // 0.6 + 2 0.25 of 5 0.6 + 2 0.25
  // Without a place: the section nearest to the middle with much missing, here where the pillar is cut.
  CHECK(view_cure(dose, target, 0.5, all, {}).title == ": cured at 0.5 relative, axial section at z = 2 mm");
  doses[9 * 7 + 4] = 1;  // it prints all the same
  dose.write_slices(0, grid.nz, doses.data());
  CHECK(view_cure(dose, target, 0.5, all, along).panels[0].picture(1, 1) == Rgb{245, 190, 140});
}
