// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>

#include "base/text/json.hpp"
#include "device/os/event_log.hpp"
#include "device/os/log_keeper.hpp"
#include "io/settings/flip_log.hpp"
#include "io/settings/run_folder.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using vam::Fault;
using vam::Json;
using vam::device::EventLog;

namespace {

// A print that was killed: flips and angles, stated in the events when there were as many, and as many after that.
struct Killed : scratch::Folder {
  Killed() {
    EventLog events(path / "events.jsonl", "vam-print");
    events("armed", {{"turns", 3}, {"from_deg", 0}});
    add();
    {
      const vam::device::LogKeeper keeper({path / "flips.jsonl", path / "angles.jsonl"}, [&](const Json& logs) {
        events("sealed", {{"logs", logs}});
      });
    }
    add();
    events("started");
    for (const char* name : {"events", "flips", "angles"}) whole[name] = scratch::slurp(log(name));
  }
  void add() const {
    EventLog flips(path / "flips.jsonl");
    EventLog angles(path / "angles.jsonl");
    for (int n = 0; n < 4; ++n) {
      flips("flip", {{"frame", n}, {"angle_deg", 6 * n}});
      angles("angle", {{"angle_deg", 6 * n}});
    }
  }
  [[nodiscard]] std::string log(const std::string& name) const { return path / (name + ".jsonl"); }
  [[nodiscard]] std::string refusal() const {
    return error_of([&] { vam::io::require_logs(path.string()); }, Fault::data);
  }
  std::map<std::string, std::string> whole;
};

}  // namespace

TEST_CASE("of a log that is cut at any byte its whole lines are known, or it is shorter than the events state") {
  Killed run;
  const auto stated = vam::io::read_events(run.path.string()).logs;
  for (const auto& [name, text] : run.whole) {
    const std::uint64_t least = name == "events" ? 0 : stated.at(name + ".jsonl").bytes;
    for (std::size_t bytes = 0; bytes <= text.size(); ++bytes) {
      const std::string rest = text.substr(0, bytes);
      scratch::spill(run.log(name), rest);
      CAPTURE(name);
      CAPTURE(bytes);
      if (rest.rfind('\n') + 1 < least) {
        CHECK(
            has(run.refusal(), name + ".jsonl: has " + std::to_string(rest.rfind('\n') + 1) + " bytes of whole lines"));
        CHECK(has(run.refusal(), "; it was cut; restore it"));
        continue;
      }
      vam::io::require_logs(run.path.string());
      if (name != "flips") continue;
      vam::io::FlipLog flips(run.path.string());
      flips.read();
      CHECK(flips.lit() == std::count(rest.begin(), rest.end(), '\n'));
    }
    scratch::spill(run.log(name), text);
  }
}

TEST_CASE("a byte that is changed anywhere in a line is found, and a log that was put in the place of another") {
  Killed run;
  for (const auto& [name, text] : run.whole) {
    for (std::size_t at = 0; at < text.size(); ++at) {
      std::string other = text;
      other[at] = other[at] == '1' ? '2' : '1';
      if (other == text || text[at] == '\n') continue;  // two lines in one are none that the next one follows
      scratch::spill(run.log(name), other);
      CAPTURE(name);
      CAPTURE(at);
      CHECK_THROWS_AS(vam::io::require_logs(run.path.string()), vam::Error);
    }
    scratch::spill(run.log(name), text);
  }
  vam::io::require_logs(run.path.string());
  std::filesystem::remove(run.log("flips"));
  CHECK(has(run.refusal(), "flips.jsonl: is gone, but events.jsonl states "));
  run.add();
  run.add();
  CHECK(has(run.refusal(), " another line than events.jsonl states (chain "));
}

TEST_CASE("what was armed, how it ended and by whom it is resumed stands in the events, the last of each") {
  const scratch::Folder folder;
  CHECK(vam::io::read_events(folder.path.string()).turns == 0);
  {
    EventLog events(folder / "events.jsonl");
    events("armed", {{"turns", 3}, {"from_deg", 100.5}, {"sinogram_sha256", "ab"}, {"resumes", "w"}});
    events("resumed", {{"by", "x"}});
    events("released");
    events("resumed", {{"by", "y"}});
    events("end", {{"outcome", "done"}, {"status", 1}});
  }
  const vam::io::RunEvents events = vam::io::read_events(folder.path.string());
  CHECK(events.turns == 3);
  CHECK(events.from_deg == 100.5);
  CHECK(events.sinogram_sha256 == "ab");
  CHECK(events.resumes == "w");
  CHECK(events.resumed_by == "y");
  CHECK(events.outcome == "done");
  CHECK(events.status == 1);
}
