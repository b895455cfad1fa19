// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/flip_log.hpp"

#include <doctest/doctest.h>

#include <fstream>

#include "fault_of.hpp"
#include "io/stream/stream.hpp"
#include "lib/io/scratch.hpp"

using vam::Fault;
using vam::io::read_shown;
using vam::io::turns_shown;

namespace {

std::string flip(double t_s, int frame, double angle_deg) {
  return R"({"utc":"x","t_monotonic_s":)" + std::to_string(t_s) + R"(,"event":"flip","sequence":1,"frame":)" +
         std::to_string(frame) + R"(,"angle_deg":)" + std::to_string(angle_deg) + "}\n";
}

}  // namespace

TEST_CASE("the exposure is that of the flips with a frame, each until the next flip") {
  const scratch::Folder folder;
  const std::string lines = R"({"event":"display"})"
                            "\n" +
                            flip(10, -1, -3) + flip(11, 0, 2) + flip(13, 1, 92) + flip(14, -1, 180);
  CHECK(read_shown(folder.write("flips.jsonl", lines)).size() == 2);
  const auto shown = read_shown(folder.path.string());
  CHECK(shown.front().seconds == 2);
  CHECK(shown.back().angle_deg == 92);
  CHECK(shown.back().seconds == 1);
  CHECK(turns_shown(shown, {4, 0, 90}, 90) == std::vector<double>{2, 1, 0, 0});
  CHECK(turns_shown({{-90, 0.5}, {719, 0.5}}, {4, 0, 90}, 90) == std::vector<double>{0.5, 0, 0, 0.5});
  CHECK(turns_shown({{90, 1}, {91, 0.5}}, {4, 180, 90}, 90) == std::vector<double>{0, 0, 0, 1.5});
  CHECK(turns_shown({{90, 1}, {-1, 0.5}}, {4, 0, -90}, 90) == std::vector<double>{0.5, 0, 0, 1});
}

TEST_CASE("in a log of several runs an image ends with its run") {
  const scratch::Folder folder;
  const std::string begin = R"({"event":"display"})"
                            "\n";
  const std::string lines =
      begin + flip(10, 0, 0) + flip(11, 1, 90) + begin + flip(9999, 2, 180) + flip(10001, -1, 190);
  const auto shown = read_shown(folder.write("flips.jsonl", lines));
  REQUIRE(shown.size() == 3);
  CHECK(shown[1].seconds == 1);
  CHECK(shown[2].seconds == 2);
}

TEST_CASE("flips count for the sinogram whose frames were on") {
  const scratch::Folder folder;
  const std::string first = folder.write("first.exr", "one");
  const std::string second = folder.write("second.exr", "two");
  const auto renewal = [](const std::string& file) {
    return R"({"event":"frames","turn":1,"sinogram_sha256":")" + vam::io::sha256_of(file) + "\"}\n";
  };
  const std::string log = folder.write("flips.jsonl", flip(10, 0, 0) + flip(11, 1, 90) + renewal(second) +
                                                          flip(13, 0, 360) + flip(14, 1, 450) + flip(18, -1, 720));
  const auto before = read_shown(log, first);
  REQUIRE(before.size() == 2);
  CHECK(before.back().seconds == 2);
  const auto after = read_shown(log, second);
  REQUIRE(after.size() == 2);
  CHECK(after.front().angle_deg == 360);
  CHECK(after.back().seconds == 4);
  CHECK(read_shown(log).size() == 4);
  error_of([&] { (void)read_shown(log, "-"); }, Fault::data);
  const std::string armed = R"({"event":"arm","sinogram_sha256":")" + vam::io::sha256_of(first) + "\"}\n";
  (void)folder.write("events.jsonl", armed);
  CHECK(read_shown(folder.path.string(), second).size() == 2);
  error_of([&] { (void)read_shown(folder.path.string(), folder.write("third.exr", "three")); }, Fault::data);
}

TEST_CASE("a log with a truncated last line is read, another file is refused") {
  const scratch::Folder folder;
  const std::string lines = flip(11, 0, 2) + flip(13, 1, 92);
  const auto shown = read_shown(folder.write("cut", lines + "{\"utc\":\"20"));
  CHECK(shown.size() == 2);
  CHECK(shown.back().seconds == 2);  // as long as the one before
  CHECK(read_shown(folder.write("empty", "")).empty());
  error_of([&] { (void)read_shown(folder.write("text", "one\ntwo\n")); }, Fault::data);
  error_of([&] { (void)read_shown(folder / "none"); }, Fault::no_input);
}

TEST_CASE("a log that grows is read line by line, and its missed blanks are counted from the last run-up turn on") {
  const scratch::Folder folder;
  const std::string path = folder.write("flips.jsonl", "");
  vam::io::FlipLog log(path);
  const auto add = [&](const std::string& text) {
    std::ofstream(path, std::ios::app) << text;
    log.read();
  };
  log.read();
  CHECK(log.shown().empty());
  const std::string late = flip(11, 0, 2);
  add(R"({"event":"flip","t_monotonic_s":1,"frame":-1,"angle_deg":-361,"missed":7})"
      "\n" +
      late.substr(0, 20));
  CHECK(log.blanks() == 0);
  add(late.substr(20) + R"({"event":"flip","t_monotonic_s":13,"frame":1,"angle_deg":92,"missed":2})" + "\n");
  CHECK(log.shown().size() == 2);
  CHECK(log.shown().front().seconds == 2);
  CHECK(log.missed() == 2);
  CHECK(log.blanks() == 4);
}
