// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/volumes.hpp"

#include <utility>

#include "lib/io/scratch.hpp"
#include "session/dose_score.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::session;

namespace {

constexpr double voxel_mm = 0.5;

/// So many voxels a side from this corner on.
model::Grid cube(int side, double corner_mm) { return {side, side, side, voxel_mm, {corner_mm, corner_mm, corner_mm}}; }

io::SparseVolume volume(const std::string& name, const model::Grid& grid, float first, float step) {
  model::Volume dense{grid, std::vector<float>(grid.size())};
  for (float& value : dense.values) value = first + step * static_cast<float>(&value - dense.values.data());
  io::SparseVolume made(name, grid);
  made.write_slices(0, grid.nz, dense.values.data());
  return made;
}

template <class... Grids>
std::string file_of(const scratch::Folder& folder, const std::string& name, Grids&&... grids) {
  std::vector<io::SparseVolume> all;
  (all.push_back(std::forward<Grids>(grids)), ...);
  io::write_volumes(folder / name, all);
  return folder / name;
}

}  // namespace

TEST_CASE("read in a larger grid, a volume has its own values inside and the given one around") {
  const model::Grid inner = cube(3, 2 * voxel_mm);
  const io::SparseVolume own = volume("tolerance", inner, 1, 0.25F);
  model::Volume all{cube(11, 0), std::vector<float>(cube(11, 0).size())};
  read_around(own, all.grid, 0.5F, 0, 4, all.slice(0));
  read_around(own, all.grid, 0.5F, 4, 7, all.slice(4));
  const model::Volume part = io::dense_volume(own);
  for (const auto [k, j, i] : indices(11, 11, 11)) {
    const bool inside = std::min({i, j, k}) >= 2 && std::max({i, j, k}) < 5;
    const float wanted = inside ? part.slice(k - 2)[(j - 2) * 3 + i - 2] : 0.5F;
    REQUIRE(all.slice(k)[j * 11 + i] == wanted);
  }
  CHECK(fault_of([&] { read_around(own, cube(4, 0), 0, 0, 4, all.slice(0)); }) == Fault::data);
}

TEST_CASE("a grid is found by its name, or as the only one of its file") {
  const model::Grid grid = cube(4, 0);
  const scratch::Folder folder;
  const std::string one = file_of(folder, "one.vdb", volume("any", grid, 0.5F, 0));
  CHECK(read_grid(one, "weight").name() == "any");
  const std::string two = file_of(folder, "two.vdb", volume("any", grid, 0.5F, 0), volume("weight", grid, 2, 0));
  CHECK(read_grid(two, "weight").name() == "weight");
  CHECK(has(error_of([&] { (void)read_grid(two, "tolerance"); }, Fault::data), "'tolerance'"));
  std::vector<io::SparseVolume> grids = read_grids(two, io::TargetKind::coverage);
  CHECK(find_grid(grids, "target") == nullptr);
  CHECK(fault_of([&] { (void)require_grid(grids, "target", two, "slice it"); }) == Fault::data);
  CHECK(taken(grids, *find_grid(grids, "any")).name() == "any");
  CHECK(grids.size() == 1);
}

TEST_CASE("what stands beside a volume is in its file, or in that of the part") {
  const model::Grid grid = cube(4, 0), inner = cube(2, voxel_mm);
  const scratch::Folder folder;
  const std::string all = file_of(folder, "all.vdb", volume("insert", inner, 1, 0), volume("target", inner, 1, 0),
                                  volume("tolerance", inner, 0.25F, 0), volume("dose", grid, 2, 0));
  const std::string dose = file_of(folder, "dose.vdb", volume("dose", grid, 2, 0));
  Companions own(all, "", io::TargetKind::coverage);
  Companions apart(dose, all, io::TargetKind::coverage);
  for (Companions* in : {&own, &apart}) {
    CHECK(in->choose("dose").grid() == grid);
    CHECK(in->target().grid() == inner);
    CHECK(in->target_around().grid() == grid);
    CHECK((in->insert()->grid() == grid && in->tolerance() != nullptr && in->file() == all));
  }
  own.choose("insert");
  CHECK(own.insert() == nullptr);
  Companions none(dose, "", io::TargetKind::coverage);
  CHECK(none.choose("").name() == "dose");
  CHECK(none.insert() == nullptr);
  CHECK(has(error_of([&] { (void)none.target(); }, Fault::data), "--target"));
  std::vector<io::SparseVolume> grids = read_like(all);  // an insert first
  CHECK(target_or_first(grids).name() == "target");
}

TEST_CASE("a target that states a unit is grey, another is coverage, unless it is said") {
  const scratch::Folder folder;
  const auto beyond = [&](const char* name, const char* units) {
    io::SparseVolume made = volume("target", cube(4, 0), 20, 0);
    made.units = units;
    return file_of(folder, name, std::move(made));
  };
  const std::string grey = beyond("grey.vdb", "mJ/cm3"), wrong = beyond("wrong.vdb", "relative");
  CHECK(read_like(grey).size() == 1);
  CHECK(fault_of([&] { (void)read_like(wrong); }) == Fault::data);
  CHECK(read_grids(wrong, {}).size() == 1);
  CHECK(read_grids(wrong, io::TargetKind::grey).size() == 1);
  CHECK(fault_of([&] { Companions(wrong, "", io::TargetKind::coverage); }) == Fault::data);
}

TEST_CASE("a dose is in mJ/cm3, scattering is not") {
  const model::Grid grid = cube(4, 0);
  const scratch::Folder folder;
  const auto with_units = [&](const char* name, const char* units) {
    io::SparseVolume made = volume(name, grid, 1, 0);
    made.units = units;
    return file_of(folder, std::string(name) + ".vdb", std::move(made));
  };
  CHECK(read_dose(with_units("dose", "mJ/cm3")).units == "mJ/cm3");
  CHECK(has(error_of([&] { (void)read_dose(with_units("dose", "relative")); }, Fault::data), "mJ/cm3"));
  CHECK(read_scatter(with_units("scatter", "view units per mm")).name() == "scatter");
  CHECK(fault_of([&] { (void)read_scatter(with_units("scatter", "mJ/cm3")); }) == Fault::data);
}

TEST_CASE("a grey target is met within the band of each voxel, and that of the options around it") {
  const model::Grid grid = cube(8, -3.5 * voxel_mm);
  const io::SparseVolume target = volume("target", grid, 1, 0);
  const io::SparseVolume dose = volume("dose", grid, 1.3F, 0);
  GreyChoice how;
  how.how.band = 0.4;
  const model::Printer printer;
  CHECK(score_grey(dose, target, how, nullptr, printer, "dose").is_met());
  how.how.band = 0.2;
  CHECK_FALSE(score_grey(dose, target, how, nullptr, printer, "dose").is_met());
  const io::SparseVolume wide = volume("tolerance", grid, 0.4F, 0);
  CHECK(score_grey(dose, target, how, &wide, printer, "dose").is_met());
  const io::SparseVolume narrow = volume("tolerance", cube(4, -1.5 * voxel_mm), 0.2F, 0);
  how.how.band = 0.4;
  CHECK_FALSE(score_grey(dose, target, how, &narrow, printer, "dose").is_met());
}
