// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/piece.hpp"

#include "testing.hpp"

using namespace vam::model;

TEST_CASE("a range has a first image and an end") {
  CHECK(parse_range("64:128") == ImageRange{64, 128});
  for (const char* text : {"", ":", "4", "4:", ":4", "4:4", "5:4", "-1:4", "0:4 ", "0:99999999999", "0x1:4"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_range(text));
  }
}

TEST_CASE("a piece is a proper part") {
  const auto piece = parse_piece("64:128 of 160");
  REQUIRE(piece);
  CHECK(*piece == Piece{{64, 128}, 160});
  CHECK(piece_text(*piece) == "64:128 of 160");
  for (const char* text : {"64:128", "0:160 of 160", "64:161 of 160", "64:128 of", "64:128 of -1", "of 160"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_piece(text));
  }
  CHECK(piece_of({0, 160}, 160).whole());
}

TEST_CASE("shares cover all images once, in whole units where there are enough") {
  for (const int count : {1, 25, 160, 1000, 50000}) {
    for (const int of : {1, 2, 3, 7, 16}) {
      if (of > count) continue;
      int end = 0;
      for (int share = 1; share <= of; ++share) {
        const auto images = ImageChoice{{}, share, of}.among(count, 64);
        REQUIRE(images);
        CHECK(images->from == end);
        CHECK(images->count() > 0);
        if (count > 64 * of) CHECK(images->from % 64 == 0);
        end = images->to;
      }
      CHECK(end == count);
    }
  }
  CHECK_FALSE(parse_choice("3/2"));
  CHECK_FALSE(parse_choice("0/2"));
  CHECK_FALSE(parse_choice("1/2")->among(1));
  CHECK_FALSE(parse_choice("0:3")->among(2));
}
