// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/private/start.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "base/error.hpp"

namespace vam::cli {

namespace {

std::terminate_handler usual = nullptr;  // NOLINT: one per process

// log4cplus, which comes with OpenVDB, starts four threads before main(), for messages that these tools never send: of
// a limit of processes they would take four, and end the process where one is refused. Until main() a thread is only
// said to be there; as a library that ends waits for its threads, the process then ends before its libraries do.
bool starting = false;      // NOLINT: one per process, and so is this
bool owes_threads = false;  // NOLINT

void leave(int status, void* /*unused*/) {
  std::fflush(nullptr);
  _exit(status);
}

// After the initialisers of all libraries, before those of the program.
[[gnu::constructor(101)]] void libraries_have_started() {
  starting = false;
  if (owes_threads) on_exit(leave, nullptr);
}

[[noreturn]] void end_for_lack() {
  std::fprintf(stderr, "%s: needs more threads or memory than the system gives; raise its limits (ulimit -u, -v)\n",
               program_invocation_short_name);
  _exit(static_cast<int>(Fault::memory));
}

[[noreturn]] void on_terminate() {
  if (starting) end_for_lack();  // before main() what is thrown may find no memory itself
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    end_for_lack();
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again) end_for_lack();
  } catch (const std::runtime_error& error) {  // in the words of oneTBB
    if (std::string_view(error.what()).starts_with("pthread_create has failed")) end_for_lack();
  } catch (...) {  // the usual one shows it
  }
  usual();
  std::abort();
}

// The system calls it before any library's initialisers.
[[gnu::section(".preinit_array"), gnu::used]] void (*const first_of_all)() = start_begins;  // NOLINT

}  // namespace

void start_begins() noexcept {
  usual = std::set_terminate(on_terminate);
  starting = true;
}

}  // namespace vam::cli

// Stands before that of the system for libraries, too. The sanitizers have one of their own.
#ifndef VAM_SANITIZED
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*routine)(void*),
                              void* argument) {
  using Create = decltype(&pthread_create);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (!vam::cli::starting) return create(thread, attributes, routine, argument);
  vam::cli::owes_threads = true;
  *thread = pthread_self();
  return 0;
}
#endif
