// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/sha256.hpp"

#include "testing.hpp"

using vam::Sha256;
using vam::sha256;

TEST_CASE("SHA-256: the examples of FIPS 180-4, whole and in pieces") {
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  const std::string million(1000000, 'a');
  CHECK(sha256(million) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  Sha256 pieces;
  for (std::size_t at = 0; at < million.size();) {
    const std::size_t part = std::min<std::size_t>(997, million.size() - at);
    pieces.add(million.data() + at, part);
    at += part;
  }
  CHECK(pieces.digest() == sha256(million));
}
