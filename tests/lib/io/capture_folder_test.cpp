// SPDX-License-Identifier: GPL-3.0-or-later
// A folder of camera frames that a later capture goes on with.
#include "io/image/capture_folder.hpp"

#include <limits>

#include "base/fingerprint.hpp"
#include "base/text/json.hpp"
#include "io/image/image_file.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;

namespace {

const Json head{{"schema", "vam-capture/1"}, {"exposure_us", 10000}};

CaptureRecord record(long place, bool complete) {
  CaptureRecord made{place, place + 7, 1.5, 0.001, 3.25, std::nullopt, 0.125, complete, "a"};
  return made;
}

GreyImage levels(std::uint16_t level) {
  GreyImage image(3, 2, 8);
  image.values.assign(6, level);
  return image;
}

std::string line_of(const std::string& frame) {
  return R"({"frame": )" + frame + R"(, "number": 1, "t_monotonic_s": 0, "complete": true, "levels": ""})";
}

}  // namespace

TEST_CASE("a folder of frames goes on where it ended, and gives back what was recorded") {
  const scratch::Folder folder;
  const std::string path = folder / "frames";
  {
    CaptureFolder frames(path, head);
    frames.keep(record(0, true), levels(10));
    frames.keep(record(1, false), levels(20));
    frames.dropped(9, 11);
    CHECK(frames.has(0));
    CHECK_FALSE(frames.has(1));
    CHECK_FALSE(frames.has(2));
  }
  // What was being written when the capture ended is no line.
  scratch::spill(path + "/manifest.jsonl", scratch::slurp(path + "/manifest.jsonl") + R"({"frame": 2, "num)");
  {
    CaptureFolder frames(path, head);
    CHECK(frames.has(0));
    CHECK_FALSE(frames.has(1));
    frames.keep(record(1, true), levels(30));
    frames.dropped(20, 20);
    frames.keep(record(0, false), levels(10));  // worse than what is there
    frames.end();
    frames.end();  // once is enough
  }
  const CaptureManifest manifest = read_manifest(path);
  Json first_line = Json::parse(manifest.head);
  CHECK(first_line.erase("seal") == 1);
  CHECK(first_line == head);
  CHECK(manifest.sealed);
  CHECK(manifest.dropped == 3 + 1);
  CHECK(manifest.ended);
  REQUIRE(manifest.frames.size() == 2);
  const CaptureRecord& first = manifest.frames.at(0);
  CHECK(first.complete);
  CHECK(first.number == 7);
  CHECK(first.t_monotonic_s == 1.5);
  CHECK(first.time_sigma_s == 0.001);
  CHECK(first.device_s == 3.25);
  CHECK_FALSE(first.angle_deg);
  CHECK(first.sigma_deg == 0.125);
  CHECK(first.levels == fingerprint(levels(10)));
  CHECK(manifest.frames.at(1).complete);
  CHECK(read_image(path + "/000001.png").values == levels(30).values);
}

TEST_CASE("no byte of a sealed manifest can change, and none of its lines go, unseen") {
  const scratch::Folder folder;
  const std::string path = folder / "frames";
  {
    CaptureFolder frames(path, head);
    for (long place = 0; place < 3; ++place)
      frames.keep(record(place, place != 1), levels(static_cast<std::uint16_t>(place)));
    frames.dropped(4, 5);
    frames.end();
  }
  const std::string file = path + "/manifest.jsonl";
  const std::string text = scratch::slurp(file);
  REQUIRE(capture_damage(path, read_manifest(path), false).empty());
  const auto noticed = [&](const std::string& changed) {
    scratch::spill(file, changed);
    std::string line;
    const int status = scratch::status(
        [&] {
          if (const auto damage = capture_damage(path, read_manifest(path), true); !damage.empty())
            throw Error{Fault::data, damage.front()};
        },
        &line);
    return status == static_cast<int>(Fault::data) && line.find("exception") == std::string::npos;
  };
  for (std::size_t at = 0; at < text.size(); ++at) {
    CAPTURE(at);
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    CHECK(noticed(changed));
  }
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    CAPTURE(begin);
    CHECK(noticed(text.substr(0, begin) + text.substr(end + 1)));
    CHECK(noticed(text.substr(0, begin)));
  }
  CHECK_FALSE(noticed(text));
}

TEST_CASE("a folder of another capture or with other files is not gone on with") {
  const scratch::Folder folder;
  const std::string path = folder / "frames";
  { const CaptureFolder frames(path, head); }
  Json other = head;
  other["exposure_us"] = 20000;
  CHECK(has(error_of([&] { const CaptureFolder frames(path, other); }, Fault::no_output),
            "exposure_us 10000, not 20000"));
  (void)folder.write("notes", "x");
  CHECK(
      has(error_of([&] { const CaptureFolder frames(folder.path, head); }, Fault::no_output), "files of another kind"));
}

TEST_CASE("a manifest whose numbers are none of frames is damaged") {
  const scratch::Folder folder;
  const auto status = [&](const std::string& text, std::string& line) {
    (void)folder.write("manifest.jsonl", head.dump() + "\n" + text + "\n");
    return scratch::status([&] { (void)read_manifest(folder.path); }, &line);
  };
  std::string line;
  CHECK(status(line_of("281474976710656"), line) == 0);
  const std::string last = std::to_string(std::numeric_limits<long>::min());
  for (const std::string frame : {"281474976710657", "1e+300", "0.5", "\"1\"", last.c_str()}) {
    CHECK(status(line_of(frame), line) == static_cast<int>(Fault::data));
    CHECK(has(line, frame + " is not the number of a frame"));
    CHECK(status(R"({"dropped": [0, )" + frame + "]}", line) == static_cast<int>(Fault::data));
  }
  CHECK(status("{}", line) == static_cast<int>(Fault::data));
  CHECK(status("{", line) == static_cast<int>(Fault::data));
  for (const auto& [key, value] : {std::pair{"columns", 1e9},
                                   {"columns", -90.0},
                                   {"rows", 0.0},
                                   {"bits", 99.0},
                                   {"pixel_mm", -1.0},
                                   {"fps", -1.0},
                                   {"every_deg", 1e300}}) {
    CAPTURE(key);
    Json wrong{{"schema", "vam-capture/1"}};
    wrong[key] = value;
    (void)folder.write("manifest.jsonl", wrong.dump() + "\n");
    CHECK_THROWS_WITH_AS((void)read_manifest(folder.path),
                         doctest::Contains((std::string(": line 1: ") + key + " is ").c_str()), Error);
  }
  (void)folder.write("manifest.jsonl",
                     R"({"schema":"vam-capture/1"}
{"frame":-1,"number":0,"t_monotonic_s":1,"complete":true,"levels":""}
)");
  CHECK_THROWS_WITH_AS((void)read_manifest(folder.path), doctest::Contains("frame -1 is before the first"), Error);
  (void)folder.write("manifest.jsonl", "");
  CHECK_THROWS_WITH_AS((void)read_manifest(folder.path), doctest::Contains("is empty"), Error);
  (void)folder.write("manifest.jsonl", "{\"schema\": \"vam-resin/1\"}\n");
  CHECK_THROWS_WITH_AS((void)read_manifest(folder.path), doctest::Contains("not a manifest"), Error);
}
