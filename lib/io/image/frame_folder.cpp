// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/frame_folder.hpp"

#include <cstdio>

#include "base/text/text.hpp"

namespace vam::io {

namespace {

constexpr const char* index_name = "frames.csv";

bool is_frame(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const bool digits = !stem.empty() && stem.find_first_not_of("0123456789") == std::string::npos;
  return file.filename() == index_name || (digits && file.extension() == ".png");
}

std::string number_name(int number) {
  char name[32];
  std::snprintf(name, sizeof name, "%05d.png", number);
  return name;
}

}  // namespace

FrameFolder::FrameFolder(const std::string& path) : folder_(path, is_frame) {}

void FrameFolder::write(int number, const GreyImage& frame, const ImageText& text) const {
  folder_.write(number_name(number), encode_png(frame, text));
}

void FrameFolder::commit(std::span<const model::ImageInfo> frames) {
  std::string index = "file,time_s,angle_deg\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    index += number_name(static_cast<int>(i)) + "," + format_number(frames[i].time_s, 9) + "," +
             format_number(frames[i].angle_deg, 9) + "\n";
  }
  folder_.write(index_name, index);
  folder_.commit();
}

}  // namespace vam::io
