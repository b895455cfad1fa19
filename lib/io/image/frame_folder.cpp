// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/image/frame_folder.hpp"

#include <cmath>
#include <cstdio>
#include <optional>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"

namespace vam::io {

namespace {

constexpr const char* index_name = "frames.csv";
constexpr const char* facts_name = "facts.txt";
constexpr const char* step_name = "vam:angle_step_deg";

bool is_frame(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const bool digits = !stem.empty() && stem.find_first_not_of("0123456789") == std::string::npos;
  return file.filename() == index_name || file.filename() == facts_name || (digits && file.extension() == ".png");
}

std::string number_name(int number) {
  char name[32];
  std::snprintf(name, sizeof name, "%05d.png", number);
  return name;
}

}  // namespace

std::string frame_facts(const model::StackInfo& info) {
  std::string text;
  for (const auto& [name, value] : info.extra) {
    if (name.starts_with("vam:") && value.find('\n') == std::string::npos) text += name + " " + trimmed(value) + "\n";
  }
  return text + step_name + " " + format_number(info.angle_step_deg, 12) + "\n";
}

void take_frame_facts(const std::string& text, model::StackInfo& info, const std::string& name) {
  std::optional<double> step;
  for (const std::string& line : split(trimmed(text), '\n')) {
    const std::size_t blank = line.find(' ');
    const std::string fact = line.substr(0, blank);
    if (!line.starts_with("vam:") || blank == std::string::npos || step || (is_own_fact(fact) && fact != step_name))
      throw Error{Fault::data, name + ": states '" + excerpt(line) + "', which is no fact of frames; write them again"};
    const std::string value = trimmed(line.substr(blank));
    if (fact == step_name)
      step = parse_number(value);
    else
      info.extra[fact] = value;
  }
  if (!step || !(std::abs(*step) <= 360))
    throw Error{Fault::data, name + ": the facts of its frames do not end with an angle as " + step_name +
                                 "; they are damaged or cut off; write them again"};
  info.angle_step_deg = *step;
}

std::string frame_seal(const std::string& facts, std::span<const Digest> frames) {
  Sealer sealer;
  sealer.add(facts);
  for (const Digest& frame : frames) sealer.add(frame);
  return std::string(values_seal_key) + " " + seal_text(sealer.digest()) + "\n";
}

FrameFolder::FrameFolder(const std::string& path) : folder_(path, is_frame) {}

Digest FrameFolder::write(int number, const GreyImage& frame, const ImageText& text) const {
  const auto png = encode_png(frame, text);
  folder_.write(number_name(number), png);
  return digest_of(png.data(), png.size());
}

void FrameFolder::commit(std::span<const model::ImageInfo> frames, const std::string& facts) {
  std::string index = "file,time_s,angle_deg\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    index += number_name(static_cast<int>(i)) + "," + format_number(frames[i].time_s, 9) + "," +
             format_number(frames[i].angle_deg, 9) + "\n";
  }
  folder_.write(index_name, index);
  if (!facts.empty()) folder_.write(facts_name, facts);
  folder_.commit();
}

}  // namespace vam::io
