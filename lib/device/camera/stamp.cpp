// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/stamp.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace vam::device {

namespace {

struct Word {
  StampMoment moment;
  const char* word;
};
constexpr std::array words{Word{StampMoment::start, "start"}, Word{StampMoment::middle, "middle"},
                           Word{StampMoment::end, "end"}};

struct Maker {
  const char* name;  // part of what the camera says, in small letters
  StampMoment moment;
};
constexpr std::array makers{
    Maker{"basler", StampMoment::start},     // pilot User's Manual, Time Stamp: when the acquisition was triggered
    Maker{"dalsa", StampMoment::start},      // Genie Nano User's Manual, timestampLatchSource: FrameStart
    Maker{"flir", StampMoment::end},         // Imaging Products timestamping: when the shutter was closed
    Maker{"point grey", StampMoment::end}};  // as FLIR

}  // namespace

const char* word_of(StampMoment moment) {
  return std::find_if(words.begin(), words.end(), [&](const Word& w) { return w.moment == moment; })->word;
}

StampMoment stamp_moment(const std::string& requested, const std::string& maker) {
  const auto* word = std::find_if(words.begin(), words.end(), [&](const Word& w) { return requested == w.word; });
  if (word != words.end()) return word->moment;
  std::string small = maker;
  std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto* known = std::find_if(makers.begin(), makers.end(),
                                   [&](const Maker& m) { return small.find(m.name) != std::string::npos; });
  return known == makers.end() ? StampMoment::end : known->moment;
}

double to_middle_s(StampMoment moment, double exposure_s) {
  if (moment == StampMoment::middle) return 0;
  return (moment == StampMoment::start ? 0.5 : -0.5) * exposure_s;
}

}  // namespace vam::device
