// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/event_log.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/text/json.hpp"
#include "device/os/clock.hpp"
#include "device/os/interrupt.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;

namespace {

struct LogFile {
  LogFile() {
    char name[] = "/tmp/vam-log-test.XXXXXX";
    close(mkstemp(name));
    path = name;
  }
  ~LogFile() { std::remove(path.c_str()); }
  [[nodiscard]] std::vector<Json> lines() const {
    std::ifstream file(path);
    std::vector<Json> all;
    for (std::string line; std::getline(file, line);) all.push_back(Json::parse(line));
    return all;
  }
  std::string path;
};

// Seconds within the hour, of "2026-11-21T04:43:00.123Z".
double seconds(const std::string& utc) { return 60 * std::stod(utc.substr(14, 2)) + std::stod(utc.substr(17, 6)); }

}  // namespace

TEST_CASE("An event has UTC and monotonic time of the same moment, also one of a while ago") {
  const LogFile file;
  EventLog log(file.path);
  const double now_s = real_clock().now_s();
  log("now");
  log.at(now_s - 75.25, "then", {{"frame", 3}});
  const auto lines = file.lines();
  REQUIRE(lines.size() == 2);
  CHECK(lines[1]["frame"] == 3);
  CHECK(lines[0]["schema"] == "vam-log/1");  // in the first line alone
  CHECK_FALSE(lines[1].contains("schema"));
  const double utc_s = std::remainder(seconds(lines[0]["utc"]) - seconds(lines[1]["utc"]), 3600);
  const double monotonic_s = lines[0]["t_monotonic_s"].get<double>() - lines[1]["t_monotonic_s"].get<double>();
  CHECK(monotonic_s >= 75.25);
  CHECK(std::abs(utc_s - monotonic_s) < 0.003);  // UTC has milliseconds
}

TEST_CASE("The cause of a tool's end is its last event, and is passed on") {
  const LogFile file;
  CHECK(fault_of([&] { logged(file.path, [] { throw Error{Fault::busy, "stage: in use"}; }); }) == Fault::busy);
  CHECK_THROWS_AS(logged(file.path, [] { throw Interrupted{15}; }), Interrupted);
  logged(file.path, [] {});
  logged("", [] {});
  const auto lines = file.lines();
  REQUIRE(lines.size() == 2);
  CHECK(lines[0]["event"] == "error");
  CHECK(lines[0]["status"] == 75);
  CHECK(lines[0]["message"] == "stage: in use");
  CHECK(lines[1]["event"] == "interrupted");
  CHECK(lines[1]["signal"] == 15);
  const auto misused = [&] {
    logged(file.path, [&] {
      EventLog(file.path)("begin");  // what is found wrong late
      throw Error{Fault::usage, "--bits: 3"};
    });
  };
  CHECK(fault_of(misused) == Fault::usage);
  CHECK(file.lines().size() == 4);
  std::filesystem::remove(file.path);
  CHECK(fault_of(misused) == Fault::usage);
  CHECK_FALSE(std::filesystem::exists(file.path));
  CHECK(fault_of([&] { logged("/nonexistent/log", [] {}); }) == Fault::no_output);
  CHECK(fault_of([&] { logged("/dev/full", [] { throw Error{Fault::busy, "x"}; }); }) == Fault::busy);
}
