// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/private/cairo_library.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <system_error>
#include <thread>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/shared_library.hpp"
#include "base/system_error.hpp"

namespace vam::plot {

namespace {

// Fontconfig reads files that name each other, and takes other fonts where it cannot open one.
void require_files() {
  constexpr std::size_t enough = 4;
  std::array<int, enough> spare{};
  int problem = 0;
  for (int& one : spare) {
    one = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
    if (one < 0 && errno == EMFILE) problem = errno;
  }
  for (const int one : spare) close(one);
  if (problem != 0) throw system_error(Fault::memory, "figure: needs 4 files open at a time", problem);
}

// Pango starts threads, and GLib below it ends the process where these or memory are refused.
void require_room() {
  constexpr std::size_t enough = std::size_t{64} << 20;  // for fonts, their list and a page
  void* room = mmap(nullptr, enough, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) {
    throw Error{Fault::memory, "figure: needs 64 MiB more than the limit of addresses (ulimit -v) leaves; raise it"};
  }
  munmap(room, enough);
  mallopt(M_ARENA_MAX, 1);  // each thread would reserve as much, and Fontconfig does not check for less
  try {
    std::thread([] {}).join();
  } catch (const std::system_error&) {
    throw Error{Fault::memory, "figure: needs one thread more than the system gives; raise its limit (ulimit -u)"};
  }
}

// GLib's last words before it ends the process, wherever the room did not suffice. Nothing may be allocated here.
void end_in_one_line(const char* domain, GLogLevelFlags level, const char* message, void* data) {
  if ((level & G_LOG_FLAG_FATAL) == 0) return cairo_api().g_log_default_handler(domain, level, message, data);
  std::array<char, 512> line{};
  const int size = std::snprintf(line.data(), line.size(), "%s: figure: %.300s; raise the limits (ulimit -v, -u)\n",
                                 program_name().c_str(), message);
  (void)!write(STDERR_FILENO, line.data(), std::min<std::size_t>(static_cast<std::size_t>(size), line.size() - 1));
  _exit(static_cast<int>(Fault::memory));
}

CairoApi load() {
  const SharedLibrary library("figure", "libpangocairo-1.0.so.0", "libpangocairo-1.0-0");
  require_room();
  require_files();
  CairoApi found{};
#define VAM_FIND(name) library.find(found.name, #name);
  VAM_CAIRO_FUNCTIONS(VAM_FIND)
#undef VAM_FIND
  found.g_log_set_default_handler(end_in_one_line, nullptr);
  return found;
}

}  // namespace

const CairoApi& cairo_api() {
  static const CairoApi loaded = load();
  return loaded;
}

}  // namespace vam::plot
