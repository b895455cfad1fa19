// SPDX-License-Identifier: GPL-3.0-or-later
// The child that parses foreign bytes: what it sends arrives, and whatever happens to it is one line and status 65.
#include "io/stream/sandboxed_reader.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "io/stream/private/sandbox.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using vam::Error;
using vam::Fault;
using namespace vam::io;

namespace {

void take_nothing(Receiver&) {}

std::string line_of(const std::function<void()>& work) {
  return error_of(
      [&] {
        read_apart(
            {"part.vdb", 1000}, [&](Sender&) { work(); }, take_nothing);
      },
      Fault::data);
}

}  // namespace

TEST_CASE("a ring returns the bytes that were put in, across many slots, in pieces of any size") {
  std::vector<std::uint32_t> numbers(1'300'001);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::uint32_t>(i * 2654435761U);
  std::vector<std::uint32_t> got(numbers.size());
  std::string text;
  read_apart(
      {"x", 1},
      [&](Sender& out) {
        out.put(std::string("a text"));
        for (std::size_t at = 0, step = 1; at < numbers.size(); at += step, step = step * 5 % 200'003 + 1) {
          out.put(&numbers[at], std::min(step, numbers.size() - at) * sizeof numbers[0]);
        }
      },
      [&](Receiver& in) {
        text = in.get<std::string>();
        for (std::size_t at = 0, step = 1; at < got.size(); at += step, step = step * 3 % 77'777 + 1) {
          in.get(&got[at], std::min(step, got.size() - at) * sizeof got[0]);
        }
      });
  CHECK(text == "a text");
  CHECK(got == numbers);
}

TEST_CASE("the crash of a child is a one-line error, and this process continues") {
  CHECK(has(line_of([] { std::abort(); }), "part.vdb: is damaged: its reader was ended by signal 6 (Aborted); "));
  CHECK(has(line_of([] { (void)std::raise(SIGKILL); }), "signal 9"));
  CHECK(has(line_of([] { _exit(0); }), "ended early"));
  CHECK(has(line_of([] { throw std::logic_error("no such thing"); }), "part.vdb: is damaged: no such thing"));
  CHECK(has(line_of([] { throw std::runtime_error("has no such thing"); }), "part.vdb: has no such thing"));
#ifndef __SANITIZE_ADDRESS__
  CHECK(has(line_of([] { *static_cast<volatile int*>(nullptr) = 1; }), "signal 11 (Segmentation fault)"));
  CHECK(has(line_of([] {
              std::vector<std::string> much;
              while (true) much.emplace_back(std::size_t{64} << 20, 'x');
            }),
            "requires more than 0.25 GiB of memory"));
#endif
}

TEST_CASE("error messages of child and parent pass unchanged") {
  const auto whose = [](Fault fault) {
    return error_of(
        [&] {
          read_apart(
              {"x", 1},
              [&](Sender&) {
                throw Error{fault, "x: why"};
              },
              take_nothing);
        },
        fault);
  };
  CHECK(whose(Fault::data) == "x: why");
  CHECK(whose(Fault::io) == "x: why");
  const auto begun = std::chrono::steady_clock::now();
  CHECK(error_of(
            [] {
              read_apart(
                  {"x", 1},
                  [](Sender& out) {
                    while (true) out.put(1);
                  },
                  [](Receiver& in) {
                    (void)in.get<int>();
                    throw Error{Fault::usage, "enough"};
                  });
            },
            Fault::usage) == "enough");
  CHECK(std::chrono::steady_clock::now() - begun < std::chrono::seconds(5));
  // More is requested than was sent; less is taken.
  CHECK(has(error_of(
                [] {
                  read_apart(
                      {"x", 1}, [](Sender&) {}, [](Receiver& in) { (void)in.get<int>(); });
                },
                Fault::data),
            "x: is damaged"));
  read_apart(
      {"x", 1},
      [](Sender& out) {
        for (int i = 0; i < 1'000'000; ++i) out.put(i);
      },
      take_nothing);
}

TEST_CASE("a sandboxed parser can neither open files nor use the network") {
  const scratch::Folder folder;
  const std::string path = folder.write("a", "0123456789");
  const int given = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const int other = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  int answers[5] = {};
  const int parent = getpid();
  {
    const scratch::Redirect to(STDERR_FILENO, folder / "said");
    read_apart(
        {"x", 10, given},
        [&](Sender& out) {
          char byte = 0;
          out.put(static_cast<int>(read(given, &byte, 1)));
          out.put(static_cast<int>(read(other, &byte, 1)));
          out.put(open(path.c_str(), O_RDONLY | O_CLOEXEC));
          out.put(socket(AF_INET, SOCK_STREAM, 0));
          out.put(kill(parent, 0));
          std::fputs("terminate called\n", stderr);
          std::fflush(stderr);
        },
        [&](Receiver& in) {
          for (int& answer : answers) answer = in.get<int>();
        });
  }
  CHECK(answers[0] == 1);
  for (int i = 1; i < 5; ++i) CHECK(answers[i] == -1);
  CHECK(scratch::slurp(folder / "said").empty());
  char rest[16] = {};
  CHECK(read(given, rest, sizeof rest) == 9);  // its place is shared
  close(given);
  close(other);
}

TEST_CASE(
    "a child may take 256 MiB, 64 times its file and what that unpacks to, and 10 s and one for 64 MiB of these") {
  constexpr std::uint64_t mib = std::uint64_t{1} << 20;
  CHECK(vam::io::bounds_of(mib, 0).memory_bytes == (256 + 64) * mib);
  CHECK(vam::io::bounds_of(mib, 64 * mib).memory_bytes == (256 + 128) * mib);
  CHECK(vam::io::bounds_of(mib, 0).cpu_s == 11);
  CHECK(vam::io::bounds_of(mib, 64 * mib).cpu_s == 12);
}
