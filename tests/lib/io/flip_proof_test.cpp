// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>

#include "base/sha256.hpp"
#include "io/settings/flip_log.hpp"
#include "io/settings/log_cross_check.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using vam::Fault;

namespace {

std::string flip(double t_s, int frame, double angle_deg) {
  return R"({"t_monotonic_s":)" + std::to_string(t_s) + R"(,"event":"flip","frame":)" + std::to_string(frame) +
         R"(,"angle_deg":)" + std::to_string(angle_deg) + "}\n";
}

std::string seal(const std::string& lines) {
  return R"({"utc":"2026-11-27T10:00:01Z","event":"sealed","log":"flips.jsonl","bytes":)" +
         std::to_string(lines.size()) + R"(,"sha256":")" + vam::sha256(lines) + "\"}\n";
}

std::string angle(double t_s, double angle_deg) {
  return R"({"t_monotonic_s":)" + std::to_string(t_s) + R"(,"angle_deg":)" + std::to_string(angle_deg) + "}\n";
}

const std::string armed = R"({"event":"armed","turns":3,"from_deg":0})"
                          "\n";

struct Run : scratch::Folder {
  Run() { (void)write("angles.jsonl", angle(9, -90) + angle(11.9, 80)); }
  std::string read(const std::string& flips) const {
    (void)write("flips.jsonl", flips);
    return error_of([&] { vam::io::FlipLog(path.string()).read(); }, Fault::data);
  }
  void holds(const std::string& flips) const {
    (void)write("flips.jsonl", flips);
    vam::io::FlipLog(path.string()).read();
  }
};

}  // namespace

TEST_CASE("a log is held to what was sealed of it while it was written; what came later may be cut") {
  const Run run;
  const std::string first = flip(10, -1, -3) + flip(11, 0, 2);
  const std::string second = first + flip(12, 1, 92);
  const std::string all = second + flip(13, 2, 182);
  (void)run.write("events.jsonl", armed + seal(first) + seal(second));
  run.holds(all);
  run.holds(second);
  run.holds(second + R"({"t_mono)");
  const std::string sealed = std::to_string(second.size());
  CHECK(has(run.read(""), "flips.jsonl: has 0 bytes of whole lines, but events.jsonl states " + sealed +
                              " at 2026-11-27T10:00:01Z; it was cut; restore it"));
  CHECK(has(run.read(first), "has " + std::to_string(first.size()) + " bytes of whole lines"));
  CHECK(has(run.read(second.substr(0, second.size() - 2)), "it was cut"));
  CHECK(has(run.read(flip(10, -1, -4) + all.substr(flip(10, -1, -4).size())), "bytes whose SHA-256 begins"));
  CHECK(
      has(run.read(all.substr(flip(10, -1, -3).size())), "no line that ends at byte " + std::to_string(first.size())));
  std::filesystem::remove(run.path / "flips.jsonl");
  CHECK(has(error_of([&] { vam::io::require_stated_flips(run.path.string()); }, Fault::data),
            "flips.jsonl: is gone, but events.jsonl states " + sealed + " bytes of it; restore it"));
  CHECK(has(error_of([&] { vam::io::FlipLog(run.path.string()).read(); }, Fault::data), "is gone"));
  // A log alone, and one by another name, are taken on trust.
  vam::io::FlipLog(run.write("copy.jsonl", first)).read();
}

TEST_CASE("a stage that turned on long after the last image proves that flips are missing") {
  const Run run;
  (void)run.write("events.jsonl", armed);
  const std::string lit = flip(10, -1, -3) + flip(11, 0, 2) + flip(12, 1, 92);
  (void)run.write("angles.jsonl", angle(9, -90) + angle(13.5, 230));
  run.holds(lit);
  (void)run.write("angles.jsonl", angle(9, -90) + angle(11, 1) + angle(14.5, 320) + R"({"t_mo)");
  CHECK(has(run.read(lit), "flips.jsonl: ends 2.5 s before angles.jsonl, in which the stage turned on to 320 deg"));
  CHECK(has(run.read(""), "has no light, 3.5 s before angles.jsonl"));
  run.holds(lit + flip(12.1, -1, 0));  // dark
  (void)run.write("angles.jsonl", angle(5, -400) + angle(9, -10));
  run.holds("");  // killed in the run-up
}

TEST_CASE("up to which flip a log is sealed is known; what was read before it was sealed is taken on trust") {
  const Run run;
  const std::string first = flip(10, -1, -3) + flip(11, 0, 2);
  (void)run.write("flips.jsonl", first + flip(12, 1, 92));
  (void)run.write("events.jsonl", armed);
  vam::io::FlipLog log(run.path.string());
  log.read();
  CHECK(log.seals_text().empty());
  (void)run.write("events.jsonl", armed + seal(first));
  log.read();
  CHECK(log.seals_text().empty());
  vam::io::FlipLog again(run.path.string());
  again.read();
  CHECK(again.seals_text() == "sealed up to flip 2 of 3; unsealed after it: 1");
}

TEST_CASE("a log that states that it is sealed has seals after some seconds") {
  const Run run;
  (void)run.write("events.jsonl", armed);
  const std::string head = R"({"t_monotonic_s":9,"event":"sinogram","full_scale":1,"seals":true})"
                           "\n";
  run.holds(head + flip(10, -1, -3) + flip(13.9, 0, 2));
  CHECK(has(run.read(head + flip(10, -1, -3) + flip(14.1, 0, 2)), "events.jsonl: has no seal of flips.jsonl"));
  (void)run.write("events.jsonl", armed + seal(""));  // killed while the disk was busy
  (void)run.write("angles.jsonl", angle(9, -90) + angle(14, 2));
  run.holds(head + flip(10, -1, -3) + flip(14.1, 0, 2));
}

TEST_CASE("whole lines of the other logs that no print leaves are refused with their number") {
  const Run run;
  const std::string lit = flip(10, -1, -3) + flip(11, 0, 2);
  const auto refused = [&](const char* log, const std::string& lines) {
    (void)run.write("events.jsonl", armed);
    (void)run.write("angles.jsonl", angle(9, -90) + angle(11, 1));
    (void)run.write(log, lines);
    return run.read(lit);
  };
  CHECK(has(refused("events.jsonl", armed + "x\n"), "events.jsonl:2: is no entry of a log (JSON)"));
  CHECK(has(refused("events.jsonl", armed + std::string(40, '\0') + "\n"), "events.jsonl:2: is no entry"));
  CHECK(has(refused("events.jsonl", "{\"event\":\"armed\",\"turns\":1e18,\"from_deg\":0}\n"), ":1: turns is 1e+18"));
  CHECK(
      has(refused("events.jsonl", "{\"event\":\"armed\",\"turns\":3,\"from_deg\":\"0\"}\n"), "from_deg is no number"));
  CHECK(has(refused("events.jsonl", armed + seal(lit) + seal("")), ":3: bytes is 0, not between"));
  CHECK(has(refused("angles.jsonl", angle(9, -90) + "[]\n"), "angles.jsonl:2: is no entry"));
  CHECK(
      has(refused("angles.jsonl", angle(9, -90) + "{\"t_monotonic_s\":9}\n"), "angles.jsonl:2: angle_deg is missing"));
}

TEST_CASE("a print that was armed has angles of all its light, but for those that a power failure loses") {
  const Run run;
  (void)run.write("events.jsonl", armed);
  const std::string lit = flip(10, -1, -3) + flip(11, 0, 2) + flip(12, 1, 92) + flip(14, 2, 182);
  run.holds(lit + flip(14.1, -1, 0));
  (void)run.write("angles.jsonl", angle(9, -90));
  run.holds(lit);
  (void)run.write("angles.jsonl", angle(8.5, -90) + R"({"t_mo)");
  CHECK(has(run.read(lit), "angles.jsonl: ends 5.5 s before light in flips.jsonl, which follows the angles; it was "));
  (void)run.write("angles.jsonl", R"({"t_mo)");
  CHECK(has(run.read(lit + flip(14.1, -1, 0)), "angles.jsonl: has no angle, but there is light in flips.jsonl"));
  run.holds(flip(10, -1, -3));
  std::filesystem::remove(run.path / "angles.jsonl");
  CHECK(has(run.read(lit), "angles.jsonl: is gone, but there is light in flips.jsonl"));
  (void)run.write("events.jsonl", seal(lit));  // of vam-project alone
  run.holds(lit);
}

TEST_CASE("what was armed is what was begun") {
  const Run run;
  const auto begun = [](const std::string& facts) {
    return R"({"t_monotonic_s":9,"event":"sinogram","full_scale":1)" + facts + "}\n" + flip(11, 0, 100);
  };
  (void)run.write("events.jsonl", R"({"event":"armed","turns":3,"from_deg":100.5,"sinogram_sha256":"abcdefghij"})"
                                  "\n");
  run.holds(begun(R"(,"turns":3,"from_deg":100.5,"sinogram_sha256":"abcdefghij")"));
  run.holds(begun(""));
  const std::string log = "events.jsonl: states ";
  CHECK(has(run.read(begun(R"(,"turns":2)")), log + "3 turns, but flips.jsonl 2; it was changed; restore it"));
  CHECK(has(run.read(begun(R"(,"turns":3,"from_deg":0)")), log + "light from 100.5 deg, but flips.jsonl 0; it was"));
  CHECK(has(run.read(begun(R"(,"sinogram_sha256":"b")")), log + "a sinogram whose SHA-256 begins abcdefgh, but "));
  CHECK(has(run.read(flip(11, 0, 90)), log + "light from 100.5 deg, but flips.jsonl has some at 90 deg; it was"));
}
