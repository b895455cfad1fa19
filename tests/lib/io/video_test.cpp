// SPDX-License-Identifier: GPL-3.0-or-later
// trials: 2000 -tc=damage sweep*
#include "io/image/video.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "io/image/private/ffv1.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"
#include "trials.hpp"

using vam::GreyImage;
using namespace vam::io;
using scratch::slurp;

namespace {

// Smooth light on black with a hard edge that moves: what projector frames look like.
GreyImage frame_of(int n, int bits, int width = 64, int height = 48) {
  GreyImage image(width, height, bits);
  for (const auto [y, x] : indices(height, width)) {
    const double light = x < 10 + n ? 0 : 0.5 + 0.5 * std::sin(0.2 * x + 0.1 * y + n);
    image(x, y) = static_cast<std::uint16_t>(std::lround(light * image.full()));
  }
  return image;
}

void write_video(const std::string& path, int frames, int bits, int width = 64, int height = 48) {
  VideoWriter writer(path, {width, height, bits, 16, "vam-project test"});
  for (int n = 0; n < frames; ++n) writer.write(frame_of(n, bits, width, height));
  writer.commit();
}

}  // namespace

TEST_CASE("FFV1 is lossless at every depth, and keeps rate, count and comment") {
  const scratch::Folder folder;
  for (const int bits : {1, 2, 4, 8, 10, 16}) {
    CAPTURE(bits);
    write_video(folder / "a.mkv", 20, bits);
    VideoReader reader(folder / "a.mkv");
    CHECK(reader.format().fps == doctest::Approx(16));
    CHECK(reader.format().bits == std::max(8, bits));
    CHECK(reader.format().comment == "vam-project test");
    GreyImage image;
    int count = 0;
    int wrong = 0;
    for (; reader.next(image); ++count) {
      const GreyImage sent = frame_of(count, bits);
      for (std::size_t i = 0; i < sent.values.size(); ++i) {
        if (image.values[i] != (bits < 8 ? sent.values[i] * 255 / sent.full() : sent.values[i])) ++wrong;
      }
    }
    CHECK(count == 20);
    CHECK(wrong == 0);
    CHECK(reader.format().checksums);
    CHECK(reader.format().seal);  // to which these frames were held
  }
}

// The bytes of libavcodec are what the tests of vam-project compare with.
TEST_CASE("FFV1 packets are made only like ones that are understood") {
  const auto sum = [](const std::uint8_t*, std::size_t) { return std::uint32_t{0x01020304}; };
  const GreyImage trial = Ffv1Frames::trial(64, 48);
  Bytes packet;
  for (const int part : {0, 1, 2, 3}) {
    Bytes slice{0xab, 0xcd};  // a head
    append_ffv1_codes(trial, {part % 2 * 32, part / 2 * 24, 32, 24}, slice);
    const std::size_t size = slice.size();
    for (const std::size_t byte : {size >> 16, size >> 8, size, std::size_t{0}, std::size_t{4}, std::size_t{3},
                                   std::size_t{2}, std::size_t{1}}) {
      slice.push_back(static_cast<std::uint8_t>(byte));
    }
    packet.insert(packet.end(), slice.begin(), slice.end());
  }
  const auto made = Ffv1Frames::like(packet, 64, 48, sum);
  REQUIRE(made);
  CHECK(made->packet(trial) == packet);
  for (const std::size_t cut : {std::size_t{1}, std::size_t{9}, packet.size() - 1, packet.size()}) {
    CHECK_FALSE(Ffv1Frames::like({packet.data(), packet.data() + packet.size() - cut}, 64, 48, sum));
  }
  for (std::size_t at = 2; at < packet.size(); at += 7) {  // behind the first head
    Bytes other = packet;
    other[at] ^= 1;
    const auto from_other = Ffv1Frames::like(other, 64, 48, sum);
    if (from_other) CHECK(from_other->packet(trial) == other);  // it was in another head
  }
}

TEST_CASE("FFV1 in colours of noise and of one level, of any size from 2 x 2, is lossless; below it is refused") {
  const scratch::Folder folder;
  for (const std::array size : {std::array{5, 4},
                                {3, 3},
                                {67, 35},
                                {130, 5},
                                {4, 2},
                                {2, 9},
                                {2, 2},
                                {2, 3},
                                {3, 2},
                                {8, 2},
                                {2, 8},
                                {4, 3},
                                {4, 4}}) {
    const auto [width, height] = size;
    CAPTURE(size[0]);
    CAPTURE(size[1]);
    GreyImage noise(width, height, 8);
    for (std::size_t i = 0; i < noise.values.size(); ++i) {
      noise.values[i] = static_cast<std::uint16_t>(i % 3 == 0 ? i * 2654435761U >> 8 & 0xff : i / 40 % 2 * 255);
    }
    GreyImage flat(width, height, 8);
    flat.values.assign(flat.values.size(), 51);
    VideoWriter writer(folder / "n.mkv", {width, height, 8, 16, ""});
    writer.write(3, [&](int) -> const GreyImage& { return noise; });
    for (int i = 0; i < 3; ++i) writer.write(flat);
    writer.commit();
    VideoReader reader(folder / "n.mkv");
    GreyImage image;
    int count = 0;
    for (; reader.next(image); ++count) CHECK(image.values == (count < 3 ? noise : flat).values);
    CHECK(count == 6);
  }
  for (const std::array size : {std::array{1, 8}, {8, 1}}) {
    CHECK(scratch::status([&] { VideoWriter(folder / "one.mkv", {size[0], size[1], 8, 16, ""}); }) == 64);
  }
}

TEST_CASE("H.264 shows the frames, odd sizes padded") {
  const scratch::Folder folder;
  write_video(folder / "a.mp4", 20, 8, 63, 47);
  VideoReader reader(folder / "a.mp4");
  CHECK(reader.format().width == 64);
  CHECK(reader.format().height == 48);
  GreyImage image;
  int count = 0;
  double error = 0;
  for (; reader.next(image); ++count) {
    const GreyImage sent = frame_of(count, 8, 63, 47);
    for (const auto [y, x] : indices(47, 63)) error += std::abs(image(x, y) - sent(x, y));
  }
  CHECK(count == 20);
  CHECK(error / (20.0 * 63 * 47) < 4);  // mean error in levels; measured 1.2, black frames would give 100
}

TEST_CASE("the same frames give the same bytes") {
  const scratch::Folder folder;
  for (const char* name : {"a.mkv", "a.mp4"}) {
    write_video(folder / name, 5, 8);
    const std::string first = slurp(folder / name);
    write_video(folder / name, 5, 8);
    CHECK(first.size() > 500);
    CHECK(slurp(folder / name) == first);
  }
}

TEST_CASE("facts stand behind the comment of any container, and a seal covers them") {
  const scratch::Folder folder;
  std::vector<VideoFormat> read;
  for (const char* name : {"a.mkv", "b.mkv", "c.mp4"}) {
    const std::string facts = "vam:printer " + std::string(name) + "\nvam:angle_step_deg 3";
    VideoWriter writer(folder / name, {64, 48, 8, 16, "vam-project test", false, facts});
    writer.write(frame_of(0, 8));
    writer.commit();
    read.push_back(VideoReader(folder / name).format());
    CHECK(read.back().comment == "vam-project test");
    CHECK(read.back().facts == facts);
  }
  REQUIRE(read[0].seal);
  CHECK(*read[0].seal != *read[1].seal);
}

TEST_CASE("without commit no file is left; other endings, missing and foreign files are refused") {
  const scratch::Folder folder;
  {
    VideoWriter writer(folder / "a.mkv", {64, 48, 8, 16, ""});
    writer.write(frame_of(0, 8));
  }
  CHECK(std::filesystem::is_empty(folder.path));
  CHECK(fault_of([&] { VideoWriter{(folder / "a.avi"), {64, 48, 8, 16, ""}}; }) == vam::Fault::usage);
  CHECK(fault_of([&] { VideoWriter{(folder / "none/a.mkv"), {64, 48, 8, 16, ""}}; }) == vam::Fault::no_output);
  CHECK(fault_of([&] { VideoReader{(folder / "a.mkv")}; }) == vam::Fault::no_input);
  std::ofstream(folder / "b.mkv") << "hello";
  CHECK(fault_of([&] { VideoReader{(folder / "b.mkv")}; }) == vam::Fault::data);
  std::filesystem::create_symlink("/dev/full", folder / "full.mkv");
  CHECK(fault_of([&] { write_video(folder / "full.mkv", 3, 8); }) == vam::Fault::io);
}

TEST_CASE("a truncated video is never read as a shorter one") {
  const scratch::Folder folder;
  for (const char* name : {"a.mkv", "a.mp4"}) {
    write_video(folder / name, 10, 8);
    const std::string whole = slurp(folder / name);
    for (std::size_t size = 0; size < whole.size(); size += 97) {
      CAPTURE(size);
      std::ofstream(folder / "cut", std::ios::binary) << whole.substr(0, size);
      bool refused = false;
      int frames = 0;
      try {
        VideoReader reader(folder / "cut");
        GreyImage image;
        while (reader.next(image)) ++frames;
      } catch (const vam::Error& error) {
        refused = error.fault == vam::Fault::data;
      }
      CHECK((refused || frames == 10));  // the last bytes of MP4 are but comments
    }
  }
}

TEST_CASE("damage sweep: every flipped bit of a lossless video is detected, and no frame is lost or shown twice") {
  const scratch::Folder folder;
  write_video(folder / "a.mkv", 12, 8);
  const std::string whole = slurp(folder / "a.mkv");
  const auto frames_of = [&](const std::string& bytes) {
    scratch::spill(folder / "b.mkv", bytes);
    VideoReader reader(folder / "b.mkv");
    std::string seen = std::to_string(reader.format().fps) + reader.format().comment;
    GreyImage image;
    while (reader.next(image)) {
      seen.append(reinterpret_cast<const char*>(image.values.data()), image.values.size() * sizeof(image.values[0]));
    }
    return seen;
  };
  const std::string wanted = frames_of(whole);
  const int trials = trials_or(200);
  unsigned state = 3;
  int refused = 0;
  for (int trial = 0; trial < trials; ++trial) {
    state = state * 1664525U + 1013904223U;
    const std::size_t at = (state >> 4) % whole.size();
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (state >> 29)));
    CAPTURE(at);
    std::string seen;
    const int ended = scratch::status([&] { seen = frames_of(damaged); });
    CHECK((ended == 65 || (ended == 0 && seen == wanted)));
    refused += ended == 65 ? 1 : 0;
  }
  CHECK(refused > trials / 2);
  MESSAGE(trials << " flips: " << refused << " refused, the rest changes nothing");
}

TEST_CASE("without the container's checksums the slices' own are held to, and the number of frames") {
  const scratch::Folder folder;
  write_video(folder / "a.mkv", 12, 8);
  // The checksum elements become fillers (Void) of the same size.
  std::string bare = slurp(folder / "a.mkv");
  for (std::size_t sum = bare.find("\xbf\x84"); sum != std::string::npos; sum = bare.find("\xbf\x84", sum + 6)) {
    bare[sum] = '\xec';
  }
  const auto read = [&](const std::string& bytes, std::string* line = nullptr) {
    scratch::spill(folder / "b.mkv", bytes);
    return scratch::status(
        [&] {
          VideoReader reader(folder / "b.mkv");
          GreyImage image;
          while (reader.next(image)) CHECK(image.width == 64);
        },
        line);
  };
  CHECK(read(bare) == 0);
  std::string line;
  const std::string first_frame("\xe7\x81\x00\xa3", 4);  // time 0, then a SimpleBlock
  const std::size_t at = bare.find(first_frame);
  REQUIRE(at != std::string::npos);
  std::string damaged = bare;
  damaged[at + 100] ^= 4;
  CHECK(read(damaged, &line) == 65);
  CHECK(has(line, "frame 0 is damaged"));
  std::string fewer = bare;
  fewer[at + 3] = '\xec';  // the frame is a filler, too
  CHECK(read(fewer, &line) == 65);
  CHECK(has(line, "has 11 of 12 frames"));
}
