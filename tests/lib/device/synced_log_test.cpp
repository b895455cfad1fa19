// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/synced_log.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "base/text/json.hpp"
#include "device/os/event_log.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;
using scratch::Folder;

namespace {

std::vector<Json> lines_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<Json> all;
  for (std::string line; std::getline(file, line);) all.push_back(Json::parse(line));
  return all;
}

}  // namespace

TEST_CASE("Lines that are written aside come in order, all of them, and whole") {
  const Folder folder;
  {
    EventLog log(folder / "log");
    log("first");
    log.write_aside();
    for (int n = 0; n < 1000; ++n) log("next", {{"n", n}});
    log.sync();
    CHECK(lines_of(folder / "log").size() == 1001);
    log("last");
  }
  const auto lines = lines_of(folder / "log");
  REQUIRE(lines.size() == 1002);
  for (int n = 0; n < 1000; ++n) CHECK(lines[n + 1]["n"] == n);
  CHECK(lines[1001]["event"] == "last");
}

TEST_CASE("Nobody waits for a log whose reader is slow") {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  constexpr int lines = 2000;  // 150 kB, more than a pipe holds
  const std::string path = "/proc/self/fd/" + std::to_string(ends[1]);
  EventLog log(path);
  log.write_aside();
  const auto begun = std::chrono::steady_clock::now();
  for (int n = 0; n < lines; ++n) log("line", {{"n", n}});
  CHECK(std::chrono::steady_clock::now() - begun < std::chrono::seconds(5));
  std::string read_back;
  std::array<char, 4096> room{};
  while (std::count(read_back.begin(), read_back.end(), '\n') < lines) {
    const ssize_t count = read(ends[0], room.data(), room.size());
    REQUIRE(count > 0);
    read_back.append(room.data(), static_cast<std::size_t>(count));
  }
  log.sync();
  close(ends[0]);
  close(ends[1]);
}

TEST_CASE("What cannot be written aside is told by the next line, and by sync()") {
  EventLog log("/dev/full");
  log.write_aside();
  log("first");
  CHECK(has(error_of([&] { log.sync(); }, Fault::io), "/dev/full: write failed (No space left on device)"));
  CHECK(fault_of([&] { log("second"); }) == Fault::io);
}

TEST_CASE("A log is sealed by its whole lines, at the latest when its keeper ends") {
  const Folder folder;
  std::ofstream(folder / "flips.jsonl") << "one\ntwo\n";
  {
    const SyncedLog keeper(folder / "flips.jsonl", folder / "events.jsonl");
    for (int tries = 0; tries < 500 && lines_of(folder / "events.jsonl").size() < 2; ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::ofstream(folder / "flips.jsonl", std::ios::app) << "three\nfou";
  }
  const auto seals = lines_of(folder / "events.jsonl");
  REQUIRE(seals.size() == 3);
  CHECK(seals[0]["event"] == "sealed");
  CHECK(seals[0]["log"] == "flips.jsonl");
  CHECK(seals[0]["bytes"] == 0);  // at once, however busy the disk is
  CHECK(seals[0]["sha256"] == sha256(""));
  CHECK(seals[1]["bytes"] == 8);
  CHECK(seals[1]["sha256"] == sha256("one\ntwo\n"));
  CHECK(seals[2]["bytes"] == 14);
  CHECK(seals[2]["sha256"] == sha256("one\ntwo\nthree\n"));
}

TEST_CASE("A keeper leaves alone what is no file, and states once that a log has nothing") {
  const Folder folder;
  { const SyncedLog keeper("", folder / "events.jsonl"); }
  { const SyncedLog keeper("-", folder / "events.jsonl"); }
  { const SyncedLog keeper("/dev/null", folder / "events.jsonl"); }
  CHECK_FALSE(std::filesystem::exists(folder / "events.jsonl"));
  std::ofstream(folder / "log") << "";
  { const SyncedLog keeper(folder / "log", folder / "events.jsonl"); }
  const auto seals = lines_of(folder / "events.jsonl");
  REQUIRE(seals.size() == 1);
  CHECK(seals[0]["bytes"] == 0);
}
