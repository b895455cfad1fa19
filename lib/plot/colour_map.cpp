#include "plot/colour_map.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace vam::plot {

namespace {

std::vector<Rgb> viridis_table() {
  cv::Mat places(1, 256, CV_8U);
  for (int i = 0; i < 256; ++i) places.at<unsigned char>(0, i) = static_cast<unsigned char>(i);
  cv::Mat colours;
  cv::applyColorMap(places, colours, cv::COLORMAP_VIRIDIS);
  std::vector<Rgb> table;
  for (int i = 0; i < 256; ++i) {
    const auto& bgr = colours.at<cv::Vec3b>(0, i);
    table.push_back({bgr[2], bgr[1], bgr[0]});
  }
  return table;
}

std::uint8_t byte(double value) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

}  // namespace

Rgb colour(ColourMap map, double place) {
  const double p = std::isnan(place) ? 0 : std::clamp(place, 0.0, 1.0);
  if (map == ColourMap::grey) return {byte(p), byte(p), byte(p)};
  if (map == ColourMap::diverging) {
    const double towards_white = 1 - std::abs(2 * p - 1);
    return p < 0.5 ? Rgb{byte(towards_white), byte(towards_white), 255}
                   : Rgb{255, byte(towards_white), byte(towards_white)};
  }
  static const std::vector<Rgb> viridis = viridis_table();
  return viridis[std::lround(255 * p)];
}

}  // namespace vam::plot
