// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of system calls.
#include "base/system_error.hpp"

#include <cerrno>

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
