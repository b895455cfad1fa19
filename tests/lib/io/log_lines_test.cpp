// SPDX-License-Identifier: GPL-3.0-or-later
// Logs that somebody may still be writing.
#include "base/log/log_lines.hpp"

#include <sys/stat.h>

#include <filesystem>

#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;

namespace {

std::vector<std::string> rest(LogLines& log) {
  std::vector<std::string> lines;
  for (std::string line; log.next(line);) lines.push_back(line);
  return lines;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("a log gives its whole lines, and later those that were added") {
  const scratch::Folder folder;
  const std::string path = folder / "log";
  LogLines none(path);
  CHECK(rest(none).empty());
  scratch::spill(path, "one\n\ntw");
  LogLines log(path);
  CHECK(rest(log) == Lines{"one", ""});
  CHECK(rest(log).empty());
  scratch::spill(path, "one\n\ntwo\nthree");
  CHECK(rest(log) == Lines{"two"});
  LogLines tail(path, 10);  // of "\ntwo\nthree"
  CHECK(rest(tail) == Lines{"two"});
  LogLines shorter(path, 9);
  CHECK(rest(shorter).empty());
  LogLines all(path, 14);
  CHECK(rest(all) == Lines{"one", "", "two"});
}

TEST_CASE("the end of a log is of the version that its first line states") {
  const scratch::Folder folder;
  scratch::spill(folder / "log", "{\"schema\":\"vam-log/2\"}\none\ntwo\n");
  CHECK(has(message_of([&] { LogLines(folder / "log", 8); }), "log: is of version 2 of its format (vam-log)"));
}

TEST_CASE("a line of 1 MiB is the longest") {
  const scratch::Folder folder;
  const std::string longest(1 << 20, 'a');
  scratch::spill(folder / "log", "b\n" + longest + "\n");
  LogLines log(folder / "log");
  CHECK(rest(log) == Lines{"b", longest});
  scratch::spill(folder / "log", "b\n" + longest + "a\n");
  LogLines beyond(folder / "log");
  std::string line;
  CHECK(beyond.next(line));
  CHECK(has(message_of([&] { (void)beyond.next(line); }), "log: has a line of more than 1 MiB, from byte 2 on"));
}

TEST_CASE("what is no regular file is not waited for, and a link that leads nowhere is an error") {
  const scratch::Folder folder;
  const std::string path = folder / "log";
  CHECK_FALSE(has_regular_file(path));
  CHECK_FALSE(has_regular_file(path + "/under"));
  scratch::spill(path, "");
  CHECK(has_regular_file(path));
  CHECK_FALSE(has_regular_file(path + "/under"));
  std::filesystem::create_symlink("log", folder / "link");
  CHECK(has_regular_file(folder / "link"));
  std::filesystem::remove(path);
  CHECK(fault_of([&] { (void)has_regular_file(folder / "link"); }) == Fault::no_input);
  std::filesystem::create_symlink("loop", folder / "loop");
  CHECK(fault_of([&] { (void)has_regular_file(folder / "loop"); }) == Fault::no_input);
  REQUIRE(mkfifo(path.c_str(), 0600) == 0);
  CHECK(fault_of([&] { (void)has_regular_file(path); }) == Fault::data);
  CHECK(fault_of([&] { (void)has_regular_file(std::string(folder / ".")); }) == Fault::data);
}
