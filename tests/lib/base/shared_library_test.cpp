// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/shared_library.hpp"

#include <sys/resource.h>

#include "testing.hpp"

using namespace vam;

TEST_CASE("a shared library's functions are found, and what is missing is reported with what to install") {
  const SharedLibrary mathematics("square roots", "libm.so.6", "libc6");
  double (*root)(double) = nullptr;
  mathematics.find(root, "sqrt");
  CHECK(root(9) == 3);
  CHECK_THROWS_WITH_AS(mathematics.find(root, "sqirt"),
                       "square roots: libm.so.6 has no function sqirt; install another release", Error);
  CHECK_THROWS_WITH_AS(SharedLibrary("video", "libnone.so.1", "libnone1"),
                       "video: libnone.so.1 cannot be loaded; install the package libnone1", Error);
}

#ifndef __SANITIZE_ADDRESS__
TEST_CASE("a library for which no addresses are left is no missing package") {
  rlimit usual{};
  REQUIRE(getrlimit(RLIMIT_AS, &usual) == 0);
  const rlimit none{1, usual.rlim_max};
  REQUIRE(setrlimit(RLIMIT_AS, &none) == 0);
  const std::string line =
      error_of([] { const SharedLibrary library("figure", "libpangocairo-1.0.so.0", "pango"); }, Fault::memory);
  setrlimit(RLIMIT_AS, &usual);
  CHECK(line ==
        "figure: no memory is left to load libpangocairo-1.0.so.0; allow more (ulimit -v), or close other "
        "programs");
}
#endif
