#include "base/shared_library.hpp"

#include <doctest/doctest.h>

#include "base/error.hpp"

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
