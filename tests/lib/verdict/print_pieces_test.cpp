// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of solids of voxels, against a flood fill.
#include "verdict/print_pieces.hpp"

#include <cstdlib>

#include "lib/verdict/printed_volume.hpp"
#include "testing.hpp"
#include "verdict/defect_voxels.hpp"
#include "verdict/private/bit_slice.hpp"
#include "verdict/private/field_shape.hpp"
#include "verdict/verdict.hpp"

using namespace vam;
using namespace vam::test;

namespace {

std::int64_t counted(const Solid& solid, std::int64_t least) {
  verdict::PieceCounter counter(least);
  for (int z = 0; z < solid.nz; ++z) {
    const auto is = [&](std::size_t i) { return solid.voxels[z * solid.nx * solid.ny + static_cast<int>(i)] != 0; };
    counter.add(verdict::BitSlice(solid.nx, solid.ny, false, is).runs(), verdict::Touching::corners);
  }
  return counter.large();
}

int flooded(Solid solid, std::int64_t least) {
  int pieces = 0;
  for (int start = 0; start < static_cast<int>(solid.voxels.size()); ++start) {
    if (solid.voxels[start] == 0) continue;
    std::int64_t size = 0;
    std::vector<int> open{start};
    solid.voxels[start] = 0;
    while (!open.empty()) {
      const int i = open.back();
      open.pop_back();
      ++size;
      const int x = i % solid.nx;
      const int y = i / solid.nx % solid.ny;
      const int z = i / solid.nx / solid.ny;
      for (int n = 0; n < 27; ++n) {
        const int u = x + n % 3 - 1;
        const int v = y + n / 3 % 3 - 1;
        const int w = z + n / 9 - 1;
        if (!solid.at(u, v, w)) continue;
        solid.voxels[(w * solid.ny + v) * solid.nx + u] = 0;
        open.push_back((w * solid.ny + v) * solid.nx + u);
      }
    }
    if (size >= least) ++pieces;
  }
  return pieces;
}

}  // namespace

TEST_CASE("pieces are those of a flood fill, at every density") {
  std::mt19937 draw(7);  // NOLINT(cert-msc51-cpp): the same solids every time
  for (const double density : {0.02, 0.06, 0.1, 0.2, 0.4, 0.9}) {
    for (int trial = 0; trial < 20; ++trial) {
      Solid solid{9, 7, 8, std::vector<char>(9 * 7 * 8)};
      std::bernoulli_distribution covered(density);
      std::generate(solid.voxels.begin(), solid.voxels.end(), [&] { return covered(draw) ? 1 : 0; });
      for (const int least : {1, 2, 8}) CHECK(counted(solid, least) == flooded(solid, least));
    }
  }
}

TEST_CASE("a wall without its foot is a piece of its own; one that hangs on by its end is cut") {
  constexpr int width = 9;
  constexpr int height = 12;
  const auto pieces = [&](int foot) {  // so many voxels of the wall's foot cure
    Print print(width, height);
    for (int k = 0; k < 8; ++k) {
      const auto part = [&](int i) { return k < 3 || i % width == 4; };
      print.add([&](int i) { return part(i) ? 1.0F : 0.0F; },
                [&](int i) { return part(i) && (k != 3 || i / width < foot); });
    }
    return print.found(1);
  };
  CHECK(pieces(height).print == 1);
  CHECK(pieces(height).broken.voxels == 0);
  CHECK(pieces(height).is_as_part());
  CHECK(pieces(2).part == 1);
  CHECK(pieces(2).part_at_half == 1);
  CHECK(pieces(2).print == 1);
  CHECK(pieces(2).broken.voxels == height - 3);  // beside the last one the wall is whole
  CHECK(!pieces(2).is_as_part());
  CHECK(pieces(0).print == 2);
  CHECK(pieces(0).broken.voxels == height);
}

TEST_CASE("rough faces and holes in walls cut nothing, however the slices come") {
  constexpr int size = 10;
  Print print(size, size);
  for (int k = 0; k < size; ++k) {
    const auto part = [&](int i) { return k < 5 || i % size == 5; };
    print.add([&](int i) { return part(i) ? 1.0F : 0.0F; },
              [&](int i) {
                const bool rough = k == 4 && i % 3 != 0 && i % size != 5;
                const bool hole = k > 5 && k < 8 && i / size % 4 == 2;
                return part(i) && !rough && !hole;
              });
  }
  for (const int a_pass : {1, 2, 3, 16}) {
    CHECK(print.found(a_pass).broken.voxels == 0);
    CHECK(print.found(a_pass).shut.voxels == 0);
    CHECK(print.found(a_pass).print == 1);
  }
}

TEST_CASE("a wall that does not cure is broken; a rod of a voxel's width holds the part together") {
  constexpr int size = 12;
  const auto found = [&](int low, int high) {  // of a wall at x = 5, no voxel of it cures within this range
    Print print(size, size);
    for (int k = 0; k < size; ++k) {
      const auto wall = [&](int i) { return i % size == 5; };
      const auto within = [&](int at) { return at >= low && at < high; };
      print.add([&](int i) { return wall(i) ? 0.8F : 0.1F; },
                [&](int i) { return wall(i) && !(within(k) && within(i / size)); });
    }
    return print.found(16);
  };
  CHECK(found(0, 0).broken.voxels == 0);
  CHECK(found(4, 6).broken.voxels == 0);
  CHECK(found(3, 8).broken.voxels == 0);  // 9 of them are torn
  CHECK(found(3, 8).holes == 1);
  CHECK(!found(3, 8).is_as_part());
  CHECK(found(0, size).broken.voxels == size * size);
  const auto blocks = [&](bool rod_cures) {  // with a rod between them that has 0.4 of its voxels
    Print print(size, size);
    for (int k = 0; k < size; ++k) {
      const bool block = k < 4 || k > 7;
      const auto rod = [&](int i) { return i == size * 6 + 6; };
      print.add([&](int i) { return block    ? 1.0F
                                    : rod(i) ? 0.4F
                                             : 0.0F; },
                [&](int i) { return block || (rod(i) && rod_cures); });
    }
    return print.found(5);
  };
  CHECK(blocks(false).part == 1);
  CHECK(blocks(false).part_at_half == 2);
  CHECK(blocks(false).print == 2);
  CHECK(!blocks(false).is_certain());  // a rod, or a gap
  CHECK(!blocks(false).is_in_other_pieces());
  CHECK(blocks(true).print == 1);
}

TEST_CASE("a channel is shut where it cures, and where what is left of it falls apart") {
  constexpr int size = 12;
  const auto found = [&](int from, int to) {  // of a block with a channel one voxel wide that cures there
    Print print(size, size);
    for (int k = 0; k < size; ++k) {
      const auto free = [&](int i) { return k == 6 && i / size == 6; };
      print.add([&](int i) { return free(i) ? 0.2F : 1.0F; },
                [&](int i) { return !free(i) || (i % size >= from && i % size < to); });
    }
    return print.found(4);
  };
  CHECK(found(0, 0).shut.voxels == 0);
  CHECK(found(3, 4).shut.voxels == 1);
  CHECK(!found(3, 4).is_as_part());
  CHECK(found(3, 6).shut.voxels == 3);
  CHECK(found(1, 11).shut.voxels == 10);
  CHECK(found(7, size).shut.voxels == 3);  // blind: of five that are lost
  CHECK(found(9, size).shut.voxels == 0);  // a rounded end
}

TEST_CASE("a cavity of one voxel that cures is shut, at the edge of the volume it is open") {
  constexpr int size = 6;
  for (const int at : {2, 5}) {
    Print print(size, size);
    for (int k = 0; k < size; ++k) {
      const auto free = [&](int i) { return k == 3 && i == 3 * size + at; };
      print.add([&](int i) { return free(i) ? 0.1F : 1.0F; }, [](int) { return true; });
    }
    CHECK(print.found(4).shut.voxels == (at == 2 ? 1 : 0));
  }
}

TEST_CASE("a strut is cut at any length, also in a frame that holds together without it; a bite is not") {
  constexpr int size = 12;
  const auto broken = [&](int from, int to, bool all) {  // of a strut of 2 x 2 voxels, the upper two or all
    Print print(size, size);
    for (int k = 0; k < 8; ++k) {
      const auto frame = [&](int i) { return i % size == 0 || i % size == size - 1 || i / size == 0; };
      const auto strut = [&](int i) { return (i / size == 6 || i / size == 7) && (k == 3 || k == 4); };
      print.add([&](int i) { return frame(i) || strut(i) ? 1.0F : 0.0F; },
                [&](int i) {
                  const bool lost = strut(i) && i % size >= from && i % size < to && (all || k == 4);
                  return (frame(i) || strut(i)) && !lost;
                });
    }
    CHECK(print.found(3).print == 1);
    return print.found(3).broken.voxels;
  };
  for (const int length : {1, 2, 3, 6}) {
    CAPTURE(length);
    CHECK(broken(3, 3 + length, true) == 4 * length);
    CHECK(broken(3, 3 + length, false) == 0);
  }
}

TEST_CASE("of two gaps in rods the larger one tells the place, however the slices come") {
  constexpr int size = 12;
  Print print(size, size);
  for (int k = 0; k < 20; ++k) {
    const auto rod = [&](int i) { return i / size == 5 && (i % size == 2 || i % size == 8); };
    const auto lost = [&](int i) { return i % size == 2 ? k >= 4 && k < 6 : k >= 11 && k < 15; };
    print.add([&](int i) { return rod(i) ? 1.0F : 0.0F; }, [&](int i) { return rod(i) && !lost(i); });
  }
  for (const int a_pass : {1, 3, 20}) {
    const verdict::PrintPieces found = print.found(a_pass);
    CHECK(found.broken.voxels == 6);
    CHECK(found.broken.largest == 4);
    CHECK(found.broken.at.column == 8);
    CHECK(found.broken.at.row == 5);
    CHECK(found.broken.at.slice >= 11);
    CHECK(found.broken.at.slice < 15);
    const verdict::GivenPrint given{.pieces = found, .grid = {size, size, 20, 0.5, {-1, -2, 3}}, .stretch_z = 1.5};
    const auto [x, y, z] = given.place_mm(found.broken).value();
    CHECK(x == doctest::Approx(3));
    CHECK(y == doctest::Approx(0.5));
    CHECK(z == doctest::Approx((3 + 0.5 * found.broken.at.slice) / 1.5));
    CHECK_FALSE(given.place_mm(found.shut));
    CHECK_FALSE(verdict::GivenPrint{.pieces = found}.place_mm(found.broken));
  }
}

TEST_CASE("holes of a thin wall are holes, and no broken voxels") {
  constexpr int size = 14;
  const auto found = [&](int apart) {  // their middles
    Print print(size, size);
    for (int k = 0; k < 7; ++k) {
      const auto wall = [&](int i) { return i / size == 6; };
      const auto hole = [&](int i) {
        for (int n = 0; n < 3; ++n) {
          if (std::abs(i % size - 2 - n * apart) <= 1 && std::abs(k - 3) <= 1) return true;
        }
        return false;
      };
      print.add([&](int i) { return wall(i) ? 1.0F : 0.0F; }, [&](int i) { return wall(i) && !hole(i); });
    }
    return print.found(7);
  };
  CHECK(found(4).broken.voxels == 0);
  CHECK(found(4).holes == 3);
  CHECK(found(4).firm_holes == 3);
  CHECK(found(1).broken.voxels == 0);
  CHECK(found(1).holes == 1);
}

TEST_CASE("a hole that only a dose moved to void would open is none") {
  constexpr int size = 9;
  const auto found = [&](float middle) {  // of a plate beside the part, with one row of another dose through it
    vam::verdict::PrintPieceCounter counter(size, size, 0.5);
    for (int k = 0; k < 5; ++k) {
      const std::vector<float> coverage(size * size, 0);
      std::vector<float> dose(size * size, 0);
      for (int i = 0; i < size * size && k > 0 && k < 4; ++i) {
        const int x = i % size;
        const int y = i / size;
        if (x > 0 && x < size - 1 && y > 0 && y < size - 1) dose[i] = x == 4 && y == 4 ? middle : 0.6F;
      }
      counter.add(dose.data(), coverage.data(), 1);
    }
    return counter.found();
  };
  CHECK(found(0.505F).holes == 0);
  CHECK(found(0.505F).firm_holes == 0);
  CHECK(found(0.1F).holes == 1);
  CHECK(found(0.1F).firm_holes == 1);
}

TEST_CASE("a fin that loses its upper half is broken, a sharp edge that is rounded is not") {
  constexpr int size = 16;
  const auto broken = [&](int lost) {  // of the upper slices of a fin of 16 voxels on a block
    Print print(size, size);
    for (int k = 0; k < 12; ++k) {
      const auto part = [&](int i) { return k < 4 || i % size == 8; };
      print.add([&](int i) { return part(i) ? 1.0F : 0.0F; }, [&](int i) { return part(i) && k < 12 - lost; });
    }
    return print.found(5).broken.voxels;
  };
  CHECK(broken(2) == 0);  // one row that nothing is left around
  CHECK(broken(3) == 2 * size);
  CHECK(broken(6) == 5 * size);
}

TEST_CASE("coverage counts from its limits on") {
  using namespace verdict::printed;
  CHECK(verdict::printed_bits(0.03F, false) == 0);
  CHECK(verdict::printed_bits(1 / 32.0F, true) == (trace | cured));
  CHECK(verdict::printed_bits(0.249F, false) == trace);
  CHECK(verdict::printed_bits(0.25F, false) == (trace | edge));
  CHECK(verdict::printed_bits(0.499F, false) == (trace | edge));
  CHECK(verdict::printed_bits(0.5F, false) == (trace | edge | part));
}

TEST_CASE("a volume of one slice, and of one column") {
  for (const auto& [width, height, slices] : {std::array{9, 1, 1}, std::array{1, 9, 1}, std::array{1, 1, 9}}) {
    verdict::PrintPieceCounter counter(width, height, 1);
    const std::vector<float> line(9, 1.0F);
    counter.add(line.data(), line.data(), slices);
    CHECK(counter.found().part == 1);
    CHECK(counter.found().print == 1);
    CHECK(counter.found().is_as_part());
  }
  CHECK(verdict::PrintPieceCounter(4, 4, 1).found().part == 0);
}

TEST_CASE("a field is joined across an edge or a corner where it is between them, by closed forms") {
  const auto pieces = [](const std::vector<float>& below, const std::vector<float>& slice) {
    verdict::FieldCounter counter(2, 2, 1, 1);
    counter.add(1, below.data());
    counter.add(1, slice.data());
    counter.connect();
    return counter.found().pieces;
  };
  // The saddle of 2, b, b, 2 is their mean: 1 at b = 0.
  CHECK(pieces({0, 0, 0, 0}, {2, 0.01F, 0.01F, 2}) == 1);
  CHECK(pieces({0, 0, 0, 0}, {2, -0.01F, -0.01F, 2}) == 2);
  CHECK(pieces({2, 0, 0.01F, 0}, {0.01F, 0, 2, 0}) == 1);
  CHECK(pieces({2, 0, -0.01F, 0}, {-0.01F, 0, 2, 0}) == 2);
  CHECK(pieces({2, 0.01F, 0, 0}, {0.01F, 2, 0, 0}) == 1);
  CHECK(pieces({2, -0.01F, 0, 0}, {-0.01F, 2, 0, 0}) == 2);
  // The saddle of 4, b, c, 1.1 for b = c: (4.4 - b^2) / (5.1 - 2 b) = 1 at b = 1 - sqrt(0.3).
  CHECK(pieces({0, 0, 0, 0}, {4, 0.453F, 0.453F, 1.1F}) == 1);
  CHECK(pieces({0, 0, 0, 0}, {4, 0.452F, 0.452F, 1.1F}) == 2);
  // The middle of eight.
  CHECK(pieces({2.5F, 0.5F, 0.5F, 0.51F}, {0.5F, 0.5F, 0.5F, 2.5F}) == 1);
  CHECK(pieces({2.5F, 0.5F, 0.5F, 0.49F}, {0.5F, 0.5F, 0.5F, 2.5F}) == 2);
}

TEST_CASE("1 % of the dose may cut off what 2 % no longer cure") {
  constexpr int width = 11;
  constexpr int height = 5;
  verdict::PrintPieceCounter counter(width, height, 0.8);
  std::vector<float> part, dose;  // a block, a rod that 1 % break, and beyond it what 1 % leave
  for (int i = 0; i < width * height; ++i) {
    const int x = i % width;
    part.push_back(x < 5 ? 1.0F : x == 5 ? 0.6F : x < 9 ? 0.9F : 0.0F);
    dose.push_back(x < 5 ? 1.0F : x == 5 ? 0.805F : x < 9 ? 0.812F : 0.0F);
  }
  for (int k = 0; k < height; ++k) counter.add(dose.data(), part.data(), 1);
  const verdict::PrintPieces found = counter.found();
  CHECK(found.print == 1);
  CHECK(found.print_least() == 1);
  CHECK(found.print_most() == 2);
}

TEST_CASE("a rod at the threshold, or a gap just below it, leaves the number of pieces open") {
  const auto found = [](float covered, float dose) {  // between two blocks
    constexpr int width = 11;
    constexpr int height = 5;
    verdict::PrintPieceCounter counter(width, height, 0.8);
    const auto slice = [&](float block, float between) {
      std::vector<float> values;
      for (int i = 0; i < width * height; ++i) values.push_back(i % width == width / 2 ? between : block);
      return values;
    };
    for (int k = 0; k < height; ++k) counter.add(slice(1, dose).data(), slice(1, covered).data(), 1);
    return counter.found();
  };
  const auto range = [&](float covered, float dose) {
    const verdict::PrintPieces pieces = found(covered, dose);
    return std::array<int, 3>{pieces.print_least(), pieces.print, pieces.print_most()};
  };
  CHECK(range(0.6F, 0.81F) == std::array{1, 1, 2});
  CHECK(range(0.4F, 0.79F) == std::array{1, 2, 2});
  CHECK(range(0.6F, 0.83F) == std::array{1, 1, 1});
  CHECK(range(1, 0.81F) == std::array{1, 1, 1});  // the process window tells of it
  CHECK(found(0.6F, 0.81F).may_be_in_other_pieces());
  CHECK(!found(0.6F, 0.83F).may_be_in_other_pieces());
}

TEST_CASE("what cures outside the circle is a piece only where it is of the part") {
  constexpr int size = 16;
  const auto print_pieces = [&](double radius, float beside) {  // of a block in the middle, and one in a corner
    std::vector<float> target;
    std::vector<float> dose;
    for (int i = 0; i < size * size * 2; ++i) {
      const int x = i % size;
      const int y = i / size % size;
      const bool middle = x >= 6 && x < 10 && y >= 6 && y < 10;
      const bool corner = x < 3 && y < 3;
      target.push_back(middle ? 1.0F : corner ? beside : 0.0F);
      dose.push_back(middle || corner ? 5.0F : 1.0F);
    }
    verdict::PrintPieceCounter pieces(size, size, 3, vam::model::Circle{7.5, 7.5, radius});
    pieces.add(dose.data(), target.data(), 1);
    pieces.add(dose.data() + size * size, target.data() + size * size, 1);
    return pieces.found().print;
  };
  CHECK(print_pieces(20, 0) == 2);
  CHECK(print_pieces(7, 0) == 1);
  CHECK(print_pieces(7, 1) == 2);
}
