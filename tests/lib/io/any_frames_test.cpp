// SPDX-License-Identifier: GPL-3.0-or-later
// Frames of videos, folders and stacks, read in the same way.
#include "io/image/any_frames.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include <limits>

#include "io/exr/stack.hpp"
#include "io/image/image_file.hpp"
#include "io/image/video.hpp"
#include "io/image/view_source.hpp"
#include "lib/io/scratch.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;

namespace {

GreyImage flat(std::uint16_t level) {
  GreyImage image(4, 2, 8);
  image.values.assign(8, level);
  return image;
}

void write_folder(const std::string& path) {
  std::filesystem::create_directory(path);
  for (int i = 0; i < 3; ++i) {
    write_png(path + "/" + std::to_string(i) + ".png", flat(static_cast<std::uint16_t>(51 * i)));
  }
}

std::vector<model::ImageInfo> facts_of(ImageSource& source) {
  std::vector<model::ImageInfo> all;
  Image image;
  for (model::ImageInfo about; source.next(image, about);) {
    CHECK(image.values.size() == 8);
    for (const float value : image.values) CHECK(value == static_cast<float>(51 * all.size()) / 255.0F);
    all.push_back(about);
  }
  return all;
}

/// As OpenEXR writes it by default (ZIP), all channels alike.
void write_exr(const std::string& path, const Image& image, const std::vector<std::string>& channels) {
  Imf::Header header(image.width, image.height);
  Imf::FrameBuffer pixels;
  for (const std::string& name : channels) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    pixels.insert(name, Imf::Slice::Make(Imf::FLOAT, image.values.data(), header.dataWindow()));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(pixels);
  file.writePixels(image.height);
}

}  // namespace

TEST_CASE("a folder of EXR images, as Dr.TVAM writes its patterns: intensities as they are") {
  const scratch::Folder folder;
  const std::string path = folder / "patterns";
  std::filesystem::create_directory(path);
  std::vector<Image> written;
  for (int i = 0; i < 12; ++i) {
    Image image(3, 2);
    for (std::size_t p = 0; p < image.size(); ++p)
      image.values[p] = 100.0F * static_cast<float>(i) + 0.1F * static_cast<float>(p);
    write_exr(path + "/" + std::string(i < 10 ? "000" : "00") + std::to_string(i) + ".exr", image, {"Y"});
    written.push_back(image);
  }
  const auto source = open_images(path, FileType::images);
  CHECK_FALSE(source->is_grey());
  CHECK(source->info().count == 12);
  CHECK(source->info().units == "relative");
  Image image;
  for (model::ImageInfo about; const Image& want : written) {
    REQUIRE(source->next(image, about));
    CHECK(image.values == want.values);
  }
  const auto refused = [&](const Image& last, const std::vector<std::string>& channels) {
    write_exr(path + "/0011.exr", last, channels);
    return error_of(
        [&] {
          const auto again = open_images(path, FileType::images);
          for (model::ImageInfo about; again->next(image, about);) continue;
        },
        Fault::data);
  };
  CHECK(has(refused(Image(3, 3), {"Y"}), "0011.exr: has 3 x 3 pixels, but those before have 3 x 2"));
  CHECK(has(refused(Image(3, 2), {"R", "G", "B"}),
            "0011.exr: has the channels B, G, R; one of intensity is read (Y); to take R: oiiotool"));
  Image endless(3, 2);
  endless.values[1] = std::numeric_limits<float>::infinity();
  CHECK(has(refused(endless, {"Y"}), "0011.exr: has a pixel that is not a finite number"));
  write_png(path + "/0.png", flat(3));
  CHECK(open_images(path, FileType::images)->info().count == 1);  // grey images go before
}

TEST_CASE("a folder of images: fractions of full, with times and angles where vam-project left them") {
  const scratch::Folder folder;
  write_folder(folder / "frames");
  const auto bare = open_images(folder / "frames", FileType::images);
  CHECK(bare->info().kind == model::Kind::frames);
  CHECK(bare->info().width == 4);
  CHECK(bare->info().height == 2);
  CHECK(bare->info().count == 3);
  CHECK(bare->info().angle_step_deg == 0);
  CHECK(bare->about().empty());
  const auto unknown = facts_of(*bare);
  REQUIRE(unknown.size() == 3);
  CHECK_FALSE(unknown[1].has_angle);
  CHECK_FALSE(unknown[1].has_time);

  const std::string head = "file,time_s,angle_deg\n";
  (void)folder.write("frames/frames.csv", head + "0.png,0.5,0\n1.png,0.75,2.5\n2.png,1,5\n");
  const auto known = open_images(folder / "frames", FileType::images);
  CHECK(known->info().angle_step_deg == 2.5);
  CHECK(known->about().size() == 3);
  const auto facts = facts_of(*known);
  CHECK(facts[1].has_angle);
  CHECK(facts[1].has_time);
  CHECK(facts[1].time_s == 0.75);
  CHECK(facts[2].angle_deg == 5);
  for (const char* rest : {"0.png,0.5,0\n1.png,0.75,2.5\n", "0.png,0.5,0,0\n1.png,0,1\n2.png,0,1\n",
                           "0.png,0.5,0\n1.png,a,2.5\n2.png,1,5\n", "0.png,0.5,0\n1.png,1,b\n2.png,1,5\n"}) {
    (void)folder.write("frames/frames.csv", head + rest);
    CHECK(fault_of([&] { (void)open_images(folder / "frames", FileType::images); }) == Fault::data);
  }
}

TEST_CASE("a video: fractions of full at its rate") {
  const scratch::Folder folder;
  {
    VideoWriter writer(folder / "a.mkv", {4, 2, 8, 20, ""});
    for (int i = 0; i < 3; ++i) writer.write(flat(static_cast<std::uint16_t>(51 * i)));
    writer.commit();
  }
  const auto video = open_images(folder / "a.mkv", FileType::video);
  CHECK(video->info().count == 3);
  CHECK(video->info().width == 4);
  const auto facts = facts_of(*video);
  REQUIRE(facts.size() == 3);
  CHECK(facts[2].has_time);
  CHECK(facts[2].time_s == doctest::Approx(0.1));
  CHECK_FALSE(facts[2].has_angle);
  CHECK(fault_of([] { (void)open_images("-", FileType::video); }) == Fault::usage);

  ViewSource views(folder / "a.mkv", 1.5);
  CameraFrame frame;
  for (int i = 0; i < 3; ++i) {
    REQUIRE(views.next(frame));
    CHECK(frame.angle_deg == 1.5 * i);
    CHECK(frame.image.values[7] == doctest::Approx(0.2 * i));
  }
  CHECK_FALSE(views.next(frame));
  CHECK(views.pixel_mm() == 0);
  CHECK(fault_of([&] { ViewSource(folder / "a.mkv", 0); }) == Fault::usage);
}

TEST_CASE("views of a folder are a step apart; a stack has its own angles or none") {
  const scratch::Folder folder;
  write_folder(folder / "frames");
  CHECK(fault_of([&] { ViewSource(folder / "frames", 0); }) == Fault::usage);
  ViewSource images(folder / "frames", -2);
  CameraFrame frame;
  for (int i = 0; i < 3; ++i) {
    REQUIRE(images.next(frame));
    CHECK(frame.angle_deg == -2 * i);
    CHECK(frame.name == folder / ("frames/" + std::to_string(i) + ".png"));
    CHECK(frame.image.values[0] == doctest::Approx(0.2 * i));
  }
  CHECK_FALSE(images.next(frame));

  model::StackInfo info{.kind = model::Kind::frames,
                        .space = model::Space::camera,
                        .width = 4,
                        .height = 2,
                        .count = 3,
                        .pixel_mm = 0.25,
                        .history = {"vam-capture"}};
  for (const double step_deg : {0.0, 3.0}) {
    info.angle_step_deg = step_deg;
    {
      StackWriter writer(folder / "v.exr", info);
      for (int i = 0; i < 3; ++i) {
        model::ImageInfo about{.angle_deg = step_deg * i,
                               .time_s = 10.0 + i,
                               .has_angle = step_deg != 0,
                               .has_time = true,
                               .time_sigma_s = 0.001,
                               .has_number = true,
                               .number = i,
                               .incomplete = i == 1};
        writer.write(Image(4, 2, static_cast<float>(1 + i)), about);
      }
      writer.commit();
    }
    ViewSource stack(folder / "v.exr", 0.5);
    CHECK(stack.pixel_mm() == 0.25);
    CHECK(stack.history()[0] == info.history[0]);
    REQUIRE(stack.next(frame));
    CHECK(frame.angle_deg == 0);
    CHECK(frame.time_s == 10);
    CHECK(frame.time_sigma_s == 0.001);
    REQUIRE(stack.next(frame));  // the second was received in part
    CHECK(frame.image.values[3] == 3);
    CHECK(frame.angle_deg == (step_deg == 0 ? 0.5 : 6));
    CHECK_FALSE(stack.next(frame));
    if (step_deg == 0) {
      ViewSource unknown(folder / "v.exr", 0);
      CHECK(fault_of([&] { (void)unknown.next(frame); }) == Fault::usage);
    }
    const Image mean = read_field(folder / "v.exr");
    CHECK(mean.values == std::vector<float>(8, 2.0F));
  }
  CHECK(read_field(folder / "frames/1.png").values[0] == doctest::Approx(0.2));
  info.space = model::Space::projector;
  {
    StackWriter writer(folder / "p.exr", info);
    for (int i = 0; i < 3; ++i) writer.write(Image(4, 2, 1));
    writer.commit();
  }
  CHECK(fault_of([&] { ViewSource(folder / "p.exr", 1); }) == Fault::data);
}

TEST_CASE("the names of images") {
  for (const char* name : {"a.png", "a.tif", "b/a.tiff"}) CHECK(is_image_file(name));
  for (const char* name : {"a.exr", "png", "a.png.exr", "tiff"}) CHECK_FALSE(is_image_file(name));
}
