// SPDX-License-Identifier: GPL-3.0-or-later
#include "verdict/verdict.hpp"

#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::verdict;

namespace {

/// A print, and what of the part its voxels do not resolve.
struct Given : GivenPrint {
  SubVoxelFeatures unresolved;
  [[nodiscard]] Verdict judged() const { return judge(unresolved, *this); }
};
std::string words(const Given& given) { return given.judged().words; }
Answer answer(const Given& given) { return given.judged().answer; }

const std::string same_pieces = "; its pieces are those of the part within +-2 % of dose";

Given printable() {
  Given made;
  made.whole.part = 100;
  made.whole.void_ = 900;
  made.whole.latitude = 0.088;
  made.whole.pw = 0.0653;
  made.with_cut = made.whole;
  made.with_cut.part = 150;
  made.with_cut.void_ = 960;
  made.with_cut.pw = -0.312;
  made.with_cut.ver = 0.0041;
  return made;
}

}  // namespace

TEST_CASE("a verdict has both figures, the voxels of each, and the seconds that are known") {
  CHECK(words(printable()) ==
        "will print: forgives +-4.4 % of dose, process window +0.0653 of the largest dose, VER 0 (1000 voxels); "
        "including "
        "the 110 voxels cut by the surface: process window -0.312, VER 0.0041");
  Given hollow = printable();
  hollow.with_cut = hollow.whole;
  hollow.whole.latitude = -0.0254;
  hollow.whole.pw = hollow.with_cut.pw = -0.02;
  hollow.whole.ver = 0.003;
  hollow.seconds = 360.04;
  CHECK(words(hollow) ==
        "will not print: latitude -0.025, process window -0.02 of the largest dose, VER 0.003 (1000 voxels); "
        "duration 360 s");
}

TEST_CASE("where the threshold is fixed, a window beside it does not print") {
  Given fixed = printable();
  fixed.whole.max_void = 0.7;
  fixed.whole.min_part = 0.8;
  fixed.threshold = 0.772;
  CHECK(answer(fixed) == Answer::yes);
  CHECK(
      words(fixed).find("will print: forgives +-4.4 % of dose, process window +0.0653 of the largest dose, VER 0 (1000 "
                        "voxels); the threshold is 3.5 % below its least dose in the part and 10 % above its largest "
                        "in the void; including the "
                        "110 voxels") == 0);
  Json figures;
  append_json(figures, fixed.judged());
  CHECK(figures["threshold_margin"]["below_part"].get<double>() == doctest::Approx(0.028 / 0.8));
  CHECK(figures["threshold_margin"]["above_void"].get<double>() == doctest::Approx(0.072 / 0.7));
  fixed.threshold = 0.8;
  CHECK(answer(fixed) == Answer::yes);
  for (const double beside : {0.7, 0.81}) {
    fixed.threshold = beside;
    CHECK(answer(fixed) == Answer::no);
    CHECK(words(fixed).find("will not print at the threshold of " + vam::format_number(beside) +
                            " (void up to 0.7, part at least 0.8): forgives +-4.4 % of dose, process window +0.0653") ==
          0);
  }
}

TEST_CASE("a part of which hardly anything is judged may print, whatever its surface shows") {
  Given rods = printable();
  rods.unresolved.whole = 1000;
  rods.unresolved.surface.emplace();
  rods.unresolved.part = 400;
  CHECK(answer(rods) == Answer::yes);
  rods.unresolved.part = 600;
  CHECK(answer(rods) == Answer::unsure);
  CHECK(has(words(rods), "are not judged: 60 % of the part"));
}

TEST_CASE("walls and gaps that no voxel shows are told") {
  Given thin = printable();
  thin.unresolved.whole = 1000;
  thin.unresolved.part = 19;
  CHECK(words(thin) == words(printable()));
  thin.unresolved.gaps = 261;
  CHECK(answer(thin) == Answer::unsure);
  CHECK(words(thin).starts_with("may print: "));
  CHECK(has(words(thin), "not judged: 28 % of the part; smaller voxels resolve them"));
  thin.unresolved.lost_walls.voxels = 14;
  CHECK(answer(thin) == Answer::not_as_designed);
  CHECK(words(thin).starts_with("will not print as designed: "));
  CHECK(has(words(thin), "; 1.4 % of the part is in walls too thin for the voxels and will be missing"));
  thin.whole.pw = -0.1;
  CHECK(words(thin).starts_with("will not print: "));
}

TEST_CASE("slits and hairs are told however small their share is") {
  Given slit = printable();
  slit.unresolved.lost_gaps = {40, 0.5F, 3, 9};
  CHECK(answer(slit) == Answer::not_as_designed);
  CHECK(has(words(slit), "gaps too narrow for the voxels will be shut"));
  Given hair = printable();
  hair.unresolved.whole = 1e6;
  hair.unresolved.lost_walls.far = hair.unresolved.lost_walls.voxels = 3;
  CHECK(answer(hair) == Answer::not_as_designed);
  CHECK(words(hair).ends_with("; walls or rods too thin for the voxels will be missing"));
  hair.unresolved.whole = 4e6;  // a millionth of which is more: feather edges
  CHECK(answer(hair) == Answer::yes);
}

TEST_CASE("a part without a voxel wholly inside is not judged") {
  Given none = printable();
  none.whole.part = 0;
  CHECK(answer(none) == Answer::not_judged);
  CHECK(words(none).starts_with("not judged, as no voxel is wholly inside the part: "));
}

TEST_CASE("pieces, cut walls and shut gaps are told of what prints") {
  Given cut = printable();
  cut.pieces = {.part = 1, .part_at_half = 1, .print = 1};
  CHECK(words(cut) == words(printable()) + same_pieces);
  CHECK(answer(cut) == Answer::yes);
  cut.pieces->print = 2;
  CHECK(answer(cut) == Answer::not_as_designed);
  CHECK(words(cut).ends_with("; the print is in 2 pieces, the part in 1"));
  cut.pieces->part_at_half = 2;  // a rod that is not seen, or a gap
  CHECK(answer(cut) == Answer::unsure);
  CHECK(words(cut).ends_with(
      "; the print is in 2 pieces, and the voxels are too coarse to tell whether the part is in 1 or 2"));
  cut.pieces = {.part = 1, .part_at_half = 1, .print = 1, .print_more = 1};
  CHECK(answer(cut) == Answer::unsure);
  CHECK(words(cut).ends_with("; the print is in 1 piece, but with up to 2 % less or more dose in 1 to 2"));
  cut.pieces = {.part = 2, .part_at_half = 2, .print = 2, .print_fewer = 1};
  CHECK(answer(cut) == Answer::unsure);
  cut.pieces->part = 1;  // which the voxels are too coarse to tell
  CHECK_FALSE(has(words(cut), "2 % less or more"));
  cut.pieces = {.part = 1, .part_at_half = 1, .print = 1, .broken = {.voxels = 4}};
  CHECK(answer(cut) == Answer::not_as_designed);
  CHECK(words(cut).ends_with("; walls are cut or missing: 4 voxels that the part fills by half or more do not cure"));
  cut.pieces->broken.at = {.column = 3, .row = 1, .slice = 8};
  cut.grid = model::centred_grid(5, 5, 9, 0.5, 1);
  cut.stretch_z = 1.25;
  CHECK(words(cut).ends_with(
      " voxels that the part fills by half or more do not cure, most at x, y, z = 0.5, -0.5, 4 mm"));
  cut.grid = {};
  cut.pieces = {.part = 1, .part_at_half = 1, .print = 1, .shut = {.voxels = 8}};
  CHECK(answer(cut) == Answer::not_as_designed);
  CHECK(words(cut).ends_with("; gaps are shut: 8 voxels that the part fills by less than a quarter cure"));
  cut.pieces = {.part = 1, .part_at_half = 1, .print = 1, .holes = 5, .firm_holes = 2};
  CHECK(answer(cut) == Answer::not_as_designed);
  CHECK(words(cut).ends_with("; walls are pierced or gaps bridged: the print has 5 holes that the part has not"));
  cut.pieces->firm_holes = 0;
  CHECK(answer(cut) == Answer::unsure);
  CHECK(
      words(cut).ends_with("; walls may be pierced or gaps bridged: the print has 5 holes that the part has not, "
                           "which 2 % less or more dose would close or open"));
  cut.pieces->holes = 1;
  cut.pieces->firm_holes = 1;
  CHECK(words(cut).ends_with("the print has 1 hole that the part has not"));
  cut.whole.pw = -0.1;  // pieces of what does not print at all say nothing
  CHECK_FALSE(has(words(cut), "pierced"));
}

TEST_CASE("an estimate that cannot tell is left open, for a reason, and reports no answer") {
  const Verdict open = leave_open(printable().judged(), "unknown at 0.26 mm; --voxel 0.1 tells");
  CHECK(open.answer == Answer::left_open);
  CHECK(open.words.starts_with(
      "unknown at 0.26 mm; --voxel 0.1 tells: forgives +-4.4 % of dose, process window +0.0653 of the largest dose"));
  Json figures;
  append_json(figures, open);
  CHECK(figures["prints"].is_null());
  CHECK(leave_open(judge({}, {}), "unknown").words == "unknown: no voxel is wholly inside the part");
}

// A dose that is the same everywhere has it: what prints the part prints the void, too.
TEST_CASE("a window of width 0 does not print, and report and message agree") {
  Given edge = printable();
  edge.whole.pw = 0;
  CHECK(answer(edge) == Answer::no);
  Json figures;
  append_json(figures, edge.judged());
  CHECK(figures["verdict"] == words(edge));
  CHECK(figures["prints"] == 0);
  CHECK(figures["with_surface"]["voxels"] == 1110);
  CHECK(figures["with_surface"]["pw"] == -0.312);
  edge.whole.pw = 0.1;
  edge.pieces = {.part = 1, .part_at_half = 1, .print = 1};
  Json good;
  append_json(good, edge.judged());
  CHECK(good["prints"] == 1);
  CHECK(good["print_pieces"] == 1);
}

TEST_CASE("the part's own surface tells its pieces and what is thin, and overrules its voxels") {
  verdict::PrintPieces counted;
  counted.part = 1;
  counted.part_at_half = counted.print = 2;
  Given made = printable();
  made.pieces = counted;
  CHECK(answer(made) == Answer::unsure);
  model::VoxelisedSurface surface{{}, 0.2};
  for (const auto& [solids, wanted] :
       {std::pair{0, Answer::unsure}, {2, Answer::yes}, {1, Answer::not_as_designed}, {3, Answer::not_as_designed}}) {
    surface.places.solids = solids;
    made.unresolved.surface = surface;
    made.pieces = counted;
    CHECK(answer(made) == wanted);
  }
  CHECK(has(words(made), "; the print is in 2 pieces, the part in 3"));
  made.unresolved.surface->places.specks = 1;  // a third solid that is too small to count on
  made.pieces = counted;
  CHECK(answer(made) == Answer::yes);

  surface.places.solids = 2;
  made.unresolved.whole = 1000;
  made.unresolved.part = 30;
  made.unresolved.surface = std::nullopt;
  made.pieces = std::nullopt;
  CHECK(answer(made) == Answer::unsure);
  made.unresolved.surface = surface;
  made.pieces = counted;
  CHECK(answer(made) == Answer::yes);
  CHECK(words(made) == words(printable()) + same_pieces);
  // Voxels that only a rough surface leaves uncovered.
  made.unresolved.lost_walls.voxels = 5;
  CHECK(answer(made) == Answer::yes);
  made.unresolved.surface->places.walls = {1, 0.18, {}};
  CHECK(answer(made) == Answer::not_as_designed);
  made.unresolved.lost_walls.voxels = 0;
  made.unresolved.surface->places.gaps = {1, 0.1, {}};
  CHECK(answer(made) == Answer::unsure);
  CHECK(has(words(made), "; walls of 0.9 voxels and gaps of 0.5 voxels are not judged; smaller voxels resolve them"));
  // What is thicker than one and a half voxels is judged.
  made.unresolved.surface->places.walls = {1, 0.31, {}};
  made.unresolved.surface->places.gaps = {1, 0.31, {}};
  CHECK(answer(made) == Answer::yes);
  made.unresolved.lost_walls.voxels = 5;  // though none of its voxels may be half covered
  CHECK(answer(made) == Answer::not_as_designed);
  made.unresolved.lost_walls.voxels = 0;
  made.unresolved.surface->places.relief = {2, 0.1, {}};
  CHECK(has(words(made), "; ridges and grooves of 0.5 voxels are not judged"));
}
