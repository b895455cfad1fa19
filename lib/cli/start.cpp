// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/private/start.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <system_error>

#include "base/error.hpp"

namespace vam::cli {

namespace {

std::terminate_handler usual = nullptr;  // NOLINT: one per process

[[noreturn]] void end_for_lack() {
  std::fprintf(stderr,
               "%s: needs more threads or memory to start than the system gives; raise its limits (ulimit -u, -v)\n",
               program_invocation_short_name);
  _exit(static_cast<int>(Fault::memory));
}

[[noreturn]] void on_terminate() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    end_for_lack();
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again) end_for_lack();
  } catch (...) {  // the usual one shows it
  }
  usual();
  std::abort();
}

// The system calls it before any library's initialisers.
[[gnu::section(".preinit_array"), gnu::used]] void (*const first_of_all)() = start_begins;  // NOLINT

}  // namespace

void start_begins() noexcept { usual = std::set_terminate(on_terminate); }

void start_ends() noexcept {
  if (usual != nullptr) std::set_terminate(usual);
}

}  // namespace vam::cli
