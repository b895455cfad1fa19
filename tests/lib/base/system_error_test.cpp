// SPDX-License-Identifier: GPL-3.0-or-later
// What the system refuses: calls, and libraries.
#include "base/system_error.hpp"

#include <sys/resource.h>

#include <cerrno>

#include "base/shared_library.hpp"
#include "testing.hpp"

using namespace vam;

TEST_CASE("the error of a system call has its words, and the remedy that helps") {
  const Error absent = system_error(Fault::no_input, "a.stl: cannot open", ENOENT);
  CHECK(absent.fault == Fault::no_input);
  CHECK(std::string(absent.what()) == "a.stl: cannot open: No such file or directory");
  const Error locked = system_error(Fault::no_output, "lock: cannot write", EACCES, "choose another folder");
  CHECK(locked.fault == Fault::no_output);
  CHECK(std::string(locked.what()) == "lock: cannot write: Permission denied; choose another folder");
  const Error many = system_error(Fault::no_output, "lock: cannot write", EMFILE, "choose another folder");
  CHECK(many.fault == Fault::memory);
  CHECK(std::string(many.what()) == "lock: cannot write: Too many open files; raise the limit (ulimit -n)");
  const Error all = system_error(Fault::no_input, "a.stl: cannot open", ENFILE);
  CHECK(all.fault == Fault::memory);
  CHECK(std::string(all.what()) == "a.stl: cannot open: Too many open files in system; close other programs");
}

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
