// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/flip_log.hpp"

#include <filesystem>
#include <fstream>

#include "io/stream/stream.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using vam::Fault;
using vam::io::read_showing;
using vam::io::turns_shown;

namespace {

std::vector<vam::io::ShownImage> read_shown(const std::string& run) {
  vam::io::FlipLog log(run);
  log.read();
  return log.shown();
}

std::string flip(double t_s, int frame, double angle_deg) {
  return R"({"utc":"x","t_monotonic_s":)" + std::to_string(t_s) + R"(,"event":"flip","frame":)" +
         std::to_string(frame) + R"(,"angle_deg":)" + std::to_string(angle_deg) + "}\n";
}

std::string sinogram(const char* event, const std::string& file, double full_scale) {
  return R"({"event":")" + std::string(event) + R"(","full_scale":)" + std::to_string(full_scale) +
         (file == "-" ? "" : R"(,"sinogram_sha256":")" + vam::io::sha256_of(file) + '"') + "}\n";
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

TEST_CASE("flips count for the sinogram whose frames were on, also when it comes back and in the next run") {
  const scratch::Folder folder;
  const std::string a = folder.write("a.exr", "one");
  const std::string b = folder.write("b.exr", "two");
  const std::string display = R"({"event":"display"})"
                              "\n";
  const std::string log =
      folder.write("flips.jsonl", display + sinogram("sinogram", a, 2) + flip(10, 0, 0) + flip(11, 1, 90) +
                                      sinogram("frames", b, 3) + flip(13, 0, 360) + flip(14, 1, 450) +
                                      sinogram("frames", a, 2) + flip(18, 0, 720) + flip(19, -1, 800) + display +
                                      sinogram("sinogram", b, 3) + flip(30, 0, 0) + flip(37, -1, 90));
  const auto seconds = [&](const std::string& file) {
    double sum = 0;
    for (const auto& image : read_showing(log, file).images) sum += image.seconds;
    return sum;
  };
  CHECK(seconds(a) == 1 + 2 + 1);
  CHECK(seconds(b) == 1 + 4 + 7);
  CHECK(read_showing(log, a).full_scale == 2);
  CHECK(read_showing(log, b).full_scale == 3);
  CHECK(read_shown(log).size() == 6);
  error_of([&] { (void)read_showing(log, "-"); }, Fault::data);
  error_of([&] { (void)read_showing(log, folder.write("c.exr", "three")); }, Fault::data);
}

TEST_CASE("light before a moment: images end there, and a print that goes on shows its last ones until then") {
  const scratch::Folder folder;
  const std::string a = folder.write("a.exr", "one");
  const std::string b = folder.write("b.exr", "two");
  const std::string lit = R"({"event":"display"})"
                          "\n" +
                          sinogram("sinogram", a, 2) + flip(9, -1, -90) + flip(10, 0, 0) + flip(11, 1, 90) +
                          sinogram("frames", b, 3) + flip(12, 2, 180) + flip(13, 3, 270);
  const std::string log = folder.write("flips.jsonl", lit);
  const auto seconds = [&](const std::string& file, double before_s) {
    double sum = 0;
    for (const auto& image : read_showing(log, file, before_s).images) sum += image.seconds;
    return sum;
  };
  CHECK(seconds(a, 9.5) == 0);
  CHECK(seconds(a, 10.5) == 0.5);
  CHECK(seconds(a, 11.5) == 1.5);
  CHECK(seconds(a, 20) == 2);
  CHECK(seconds(b, 12.5) == 0.5);
  CHECK(seconds(b, 14) == 2);
  CHECK(seconds(b, 17.25) == 5.25);
  const auto images = read_showing(log, b, 16.5).images;
  REQUIRE(images.size() == 5);
  CHECK(images[2].angle_deg == 360);
  CHECK(images[4].angle_deg == 540);
  CHECK(images[4].seconds == 0.5);
  CHECK(has(message_of([&] { (void)seconds(b, 1e8); }), "the light would go on for 1e+08 images"));
  const std::string over = folder.write("flips.jsonl", lit + flip(14, -1, 360));
  CHECK(seconds(b, 17.25) == 2);
}

TEST_CASE("a log that states no sinogram, or one from a pipe, is taken on trust") {
  const scratch::Folder folder;
  const std::string a = folder.write("a.exr", "one");
  for (const std::string& begin : {std::string(), sinogram("sinogram", "-", 2)}) {
    const std::string log = folder.write("flips.jsonl", begin + flip(10, 0, 0) + flip(12, -1, 90));
    CHECK(read_showing(log, a).images.size() == 1);
    CHECK(read_showing(log, "-").images.size() == 1);
    CHECK(read_showing(log, a).full_scale == (begin.empty() ? 0 : 2));
  }
}

TEST_CASE("a sinogram whose full scale changes within a log has no dose") {
  const scratch::Folder folder;
  const std::string a = folder.write("a.exr", "one");
  const std::string runs = sinogram("sinogram", a, 2) + flip(10, 0, 0) + flip(12, -1, 90);
  const std::string log = folder.write("flips.jsonl", runs + sinogram("sinogram", a, 4) + flip(20, 0, 0));
  error_of([&] { (void)read_showing(log, a); }, Fault::data);
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

TEST_CASE("numbers that no print has are refused, with their line") {
  const scratch::Folder folder;
  const auto refusal = [&](const std::string& second) {
    (void)folder.write("log", R"({"event":"sinogram","full_scale":1,"frames":60,"turns":3})"
                              "\n" +
                                  flip(10, 0, 0) + second);
    return error_of([&] { (void)read_shown(folder / "log"); }, Fault::data);
  };
  const char* remedy = "; the log was changed; restore it";
  CHECK(has(refusal(flip(11, 99999, 6)), std::string(":3: frame 99999 is none of the 60 of the print") + remedy));
  CHECK(has(refusal(flip(11, 60, 6)), "frame 60 is none of the 60"));
  CHECK(has(refusal(flip(11, -2, 6)), "frame -2 is not a whole number from -1 to"));
  CHECK(has(refusal(flip(1e308, 1, 6)), "time 1e+308 s is not between 0 and 1e+09 s"));
  CHECK(has(refusal(flip(-1, 1, 6)), "time -1 s"));
  CHECK(has(refusal(flip(11, 1, -1000)), "angle -1000 deg is not between 0 and 1080 deg, where images are shown"));
  CHECK(has(refusal(flip(11, 1, 1081)), "angle 1081 deg"));
  CHECK(has(refusal(flip(11, -1, 1e300)), "angle 1e+300 deg"));
  const std::string line = R"({"event":"flip","t_monotonic_s":11,"angle_deg":6,"frame":)";
  CHECK(has(refusal(line + "1.5}\n"), "frame 1.5 is not a whole number"));
  CHECK(has(refusal(line + "18446744073709551615}\n"), "is not a whole number"));
  CHECK(has(refusal(line + "1,\"missed\":-1}\n"), "missed -1"));
}
