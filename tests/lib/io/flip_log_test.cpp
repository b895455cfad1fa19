#include "io/settings/flip_log.hpp"

#include <doctest/doctest.h>

#include "fault_of.hpp"
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

TEST_CASE("what was shown is the flips with a frame, each until the next flip") {
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

TEST_CASE("an image does not last into the next run of one log") {
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

TEST_CASE("a log that its writer's death cut is read, another file is refused") {
  const scratch::Folder folder;
  const std::string lines = flip(11, 0, 2) + flip(13, 1, 92);
  const auto shown = read_shown(folder.write("cut", lines + "{\"utc\":\"20"));
  CHECK(shown.size() == 2);
  CHECK(shown.back().seconds == 2);  // as long as the one before
  CHECK(read_shown(folder.write("empty", "")).empty());
  error_of([&] { (void)read_shown(folder.write("text", "one\ntwo\n")); }, Fault::data);
  error_of([&] { (void)read_shown(folder / "none"); }, Fault::no_input);
}
