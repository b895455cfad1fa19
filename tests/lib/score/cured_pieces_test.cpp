// SPDX-License-Identifier: GPL-3.0-or-later
#include "score/cured_pieces.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace vam;

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
    score::CuredPieces pieces({7.5, 7.5, radius}, 3, size, size);
    pieces.add(dose.data(), target.data(), 1);
    pieces.add(dose.data() + size * size, target.data() + size * size, 1);
    return pieces.found().print;
  };
  CHECK(print_pieces(20, 0) == 2);
  CHECK(print_pieces(7, 0) == 1);
  CHECK(print_pieces(7, 1) == 2);
}
