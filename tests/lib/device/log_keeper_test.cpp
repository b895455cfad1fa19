// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/log_keeper.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/log/log_lines.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
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

TEST_CASE("What is whole of logs is stated when it is on the disk, at the latest when their keeper ends") {
  const Folder folder;
  std::vector<Json> stated;
  EventLog log(folder / "a.jsonl");
  const auto chain = [&] { return lines_of(folder / "a.jsonl").back()["chain"]; };
  log("one");
  {
    const LogKeeper keeper({"", "-", "/dev/null", folder / "a.jsonl", folder / "b.jsonl"},
                           [&](const Json& logs) { stated.push_back(logs); });
    for (int tries = 0; tries < 500 && stated.empty(); ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    log("two");
    std::ofstream(folder / "b.jsonl") << "three\nfou";
  }
  REQUIRE(stated.size() == 2);
  CHECK(stated[0].size() == 1);
  CHECK(stated[0]["a.jsonl"]["chain"] == lines_of(folder / "a.jsonl").front()["chain"]);
  CHECK(stated[1]["a.jsonl"] == Json{{"bytes", std::filesystem::file_size(folder / "a.jsonl")}, {"chain", chain()}});
  CHECK(stated[1]["b.jsonl"] == Json{{"bytes", 6}, {"chain", ""}});
}

TEST_CASE("A line follows from the one before, whoever wrote that, and one that was begun is cut off") {
  const Folder folder;
  const std::string path = folder / "log";
  const auto whole = [&] {
    LogLines lines(path);
    long count = 0;
    for (Json line; lines.next(line);) ++count;
    return lines.is_chained() ? count : -count;
  };
  {
    EventLog first(path);
    EventLog second(path);
    first("a");
    second("b");
    first("c");
  }
  CHECK(whole() == 3);
  const auto write = [&] {
    EventLog log(path);
    for (int i = 0; i < 200; ++i) log("at once");
  };
  std::thread beside(write);
  write();
  beside.join();
  CHECK(whole() == 403);
  std::filesystem::remove(path);
  for (int i = 0; i < 3; ++i) EventLog(folder / "log")("again");
  std::ofstream(path, std::ios::app) << "{\"utc";
  EventLog(folder / "log")("d");
  CHECK(whole() == 4);
  const std::string text = scratch::slurp(path);
  const auto refused = [&](const std::string& other) {
    scratch::spill(path, other);
    return has(message_of([&] { (void)whole(); }), ": does not follow from the line before it; the log was changed");
  };
  std::vector<std::string> lines = split(text, '\n');
  lines.pop_back();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<std::string> other = lines;
    other[i].replace(other[i].find("event"), 5, "evens");
    CHECK(refused(join(other, "\n") + "\n"));
    other = lines;
    other.insert(other.begin() + static_cast<std::ptrdiff_t>(i), lines[i]);
    CHECK(refused(join(other, "\n") + "\n"));
    if (i + 1 == lines.size()) continue;  // a cut tail is for who knows how long it was
    other = lines;
    other.erase(other.begin() + static_cast<std::ptrdiff_t>(i));
    CHECK(refused(join(other, "\n") + "\n"));
    other = lines;
    std::swap(other[i], other[i + 1]);
    CHECK(refused(join(other, "\n") + "\n"));
  }
  scratch::spill(path, "{\"event\":\"of another program\"}\n");
  EventLog(folder / "log")("e");
  CHECK(whole() == -2);
}
