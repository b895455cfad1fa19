// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/cut_off.hpp"

#include <string>

#include "base/error.hpp"

namespace vam::metrology {

namespace {

constexpr double dark_share = 0.4;     // of a column's pixels at level 0: half of them in the dark
constexpr double dark_columns = 0.25;  // of all, at least: fewer may be so by chance

BandReading read_band(const Image& frame, int first, int last) {
  BandReading band;
  double dark = 0;
  BandReading of_dark;
  for (int x = 0; x < frame.width; ++x) {
    double light = 0;
    double zeros = 0;
    for (int y = first; y < last; ++y) {
      light += frame(x, y);
      zeros += frame(x, y) == 0 ? 1 : 0;
    }
    band.pixels += last - first;
    band.light += light;
    band.zeros += zeros;
    if (zeros < dark_share * (last - first)) continue;
    ++dark;
    of_dark.dark_light += light;
    of_dark.dark_zeros += zeros;
  }
  if (dark >= dark_columns * frame.width) band.add(of_dark);
  return band;
}

}  // namespace

void BandReading::add(const BandReading& other) {
  pixels += other.pixels;
  light += other.light;
  zeros += other.zeros;
  dark_light += other.dark_light;
  dark_zeros += other.dark_zeros;
}

std::vector<BandReading> band_readings(const Image& frame, int bands) {
  if (frame.height < bands) {
    throw Error{Fault::data, "sweep: " + std::to_string(frame.height) + " rows are too few for " +
                                 std::to_string(bands) + " heights"};
  }
  const int rows = frame.height / bands;
  std::vector<BandReading> readings;
  for (int b = 0; b < bands; ++b) readings.push_back(read_band(frame, b * rows, (b + 1) * rows));
  return readings;
}

std::vector<double> without_cut_off(const std::vector<BandReading>& readings) {
  BandReading all;
  for (const BandReading& reading : readings) all.add(reading);
  const double lift = all.dark_zeros > 0 ? all.dark_light / all.dark_zeros : 0;  // for each pixel at level 0
  std::vector<double> means;
  for (const BandReading& reading : readings) means.push_back(reading.mean() - lift * reading.zeros / reading.pixels);
  return means;
}

}  // namespace vam::metrology
